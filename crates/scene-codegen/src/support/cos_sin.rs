/// Cosine and sine of x (rad) within one unit in the last place.
#[inline(always)]
fn cos_sin(x: f64) -> [f64; 2] {
    if x.abs() < 1e6 {
        return cos_sin_of_small(x);
    }
    let (sin, cos) = x.sin_cos();
    [cos, sin]
}

/// The same for |x| < 1e6, without a branch: x is reduced by multiples of π/2 in two parts, the rest is that of fdlibm (polynomials of
/// degree 13 and 12; coefficients of Sun Microsystems' k_sin.c and k_cos.c, 1993).
#[inline(always)]
fn cos_sin_of_small(x: f64) -> [f64; 2] {
    // Adding it rounds to an integer, whose last bits are then those of the sum.
    const ROUND: f64 = 6755399441055744.0;
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let turns = shifted - ROUND;
    let far = x - turns * 1.570_796_326_734_125_614_17;
    let near = turns * 6.077_100_506_506_192_249_32e-11;
    let y = far - near;
    let rest = (far - y) - near;
    let z = y * y;
    let w = z * z;
    let cube = z * y;
    let r = (8.333_333_333_322_489e-3 + z * (-1.984_126_982_985_795e-4 + z * 2.755_731_370_707_006_8e-6))
        + z * w * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10);
    let sin = y - ((z * (0.5 * rest - cube * r) - rest) + cube * 1.666_666_666_666_663_2e-1);
    let r = z
        * (4.166_666_666_666_66e-2
            + z * (-1.388_888_888_887_411e-3 + z * 2.480_158_728_947_673e-5))
        + w * w
            * (-2.755_731_435_139_066_3e-7
                + z * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11));
    let half = 0.5 * z;
    let head = 1.0 - half;
    let cos = head + (((1.0 - head) - half) + (z * r - y * rest));
    let odd = quadrant & 1 == 1;
    let (c, s) = (if odd { sin } else { cos }, if odd { cos } else { sin });
    [
        f64::from_bits(c.to_bits() ^ ((quadrant.wrapping_add(1) & 2) << 62)),
        f64::from_bits(s.to_bits() ^ ((quadrant & 2) << 62)),
    ]
}
