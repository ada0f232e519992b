//! Seeded numbers, the same on every machine.

/// SplitMix64 (Steele, Lea, Flood 2014, doi 10.1145/2714064.2660195).
#[derive(Clone, Debug)]
pub(super) struct Numbers(u64);

impl Numbers {
    /// The stream of a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between two numbers, the upper one excluded but for rounding.
    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        low + unit * (high - low)
    }

    /// In 0..n; 0 where n is 0.
    pub(super) fn below(&mut self, n: usize) -> usize {
        let n = (n as u64).max(1);
        (self.bits() % n) as usize
    }
}

/// The direction at an angle from the x-axis.
pub(super) fn direction(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// `point + length·direction`
pub(super) fn step(point: [f64; 2], length: f64, direction: [f64; 2]) -> [f64; 2] {
    [
        point[0] + length * direction[0],
        point[1] + length * direction[1],
    ]
}

/// Halfway between two points.
pub(super) fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}
