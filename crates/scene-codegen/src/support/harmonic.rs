/// `amplitude·sin(omega·t + phase) + offset` with two derivatives.
fn harmonic(t: f64, [amplitude, omega, phase, offset]: [f64; 4]) -> [f64; 3] {
    let [cos, sin] = cos_sin(omega * t + phase);
    [
        amplitude * sin + offset,
        amplitude * omega * cos,
        -amplitude * omega * omega * sin,
    ]
}
