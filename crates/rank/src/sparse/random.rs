//! Pseudo-random numbers from a counter. The same seed and index give the same bits on every
//! platform.
//!
//! The numbers are uniform, not normal. Uniform numbers avoid logarithms and cosines, whose last
//! bits differ between platforms. Uniform values have the same required properties as normal
//! values. The mean is zero and the variance is one, so `E (zᵀx)² = ‖z‖²`. The product `zᵀx` is
//! rarely much smaller: for ‖z‖ = 1 its density is at most `√2/(2·√3) < 0.41` (normal: 0.40),
//! because no section of the unit cube is larger than √2.
//!
//! Source: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators,
//! OOPSLA (2014), for SplitMix64; K. Ball, Cube slicing in Rⁿ, Proc. Amer. Math. Soc. 97 (1986)
//! 465–473.

use super::reflectors::Lanes;

/// Factor in `P(|zᵀx| < ε) ≤ DENSITY·ε` for ‖z‖ = 1: twice the largest density.
pub(super) const DENSITY: f64 = 0.82;

/// Returns `n` rows of numbers between −√3 and √3. Different streams have different numbers.
pub(super) fn uniform(n: usize, seed: u64, stream: u64) -> Vec<Lanes> {
    let key = mix(seed ^ mix(stream));
    let lane = |i: usize, l: usize| {
        let place = (i * size_of::<Lanes>() / size_of::<f64>() + l) as u64;
        // The upper 53 bits are centred, so the number is never zero.
        let k = mix(key.wrapping_add(place.wrapping_mul(GOLDEN))) >> 11;
        (k as f64 + 0.5 - HALF) / HALF * 3f64.sqrt()
    };
    (0..n)
        .map(|i| std::array::from_fn(|l| lane(i, l)))
        .collect()
}

/// The constant 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The constant 2⁵².
const HALF: f64 = 4_503_599_627_370_496.0;

/// Returns the output function of SplitMix64.
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance() {
        let x = uniform(20_000, 1, 0);
        let all = x.as_flattened();
        let n = all.len() as f64;
        let mean = all.iter().sum::<f64>() / n;
        let square = all.iter().map(|x| x * x).sum::<f64>() / n;
        // The limits are four standard deviations: 4/√n, and 4·√(4/5)/√n.
        assert!(mean.abs() < 4.0 / n.sqrt(), "{mean}");
        assert!((square - 1.0).abs() < 3.6 / n.sqrt(), "{square}");
        assert!(all.iter().all(|x| x.abs() <= 3f64.sqrt()));
    }

    #[test]
    fn streams_and_seeds_differ() {
        let x = uniform(3, 1, 0);
        assert_eq!(x, uniform(3, 1, 0));
        assert_ne!(x, uniform(3, 2, 0));
        assert_ne!(x, uniform(3, 1, 1));
    }
}
