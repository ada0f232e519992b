//! Random numbers of a sample. Each datum has a separate stream, so that a sample depends only on
//! the seed and on the index of the sample, and not on numbers that were drawn earlier.
//!
//! Source: SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA
//! 2014). The hash that separates the streams is also SplitMix64.

/// The increment of SplitMix64: the odd integer nearest to 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Random numbers of one datum of one sample.
pub(super) struct Stream(u64);

impl Stream {
    /// Creates the stream of datum `place` of sample `number` for a seed.
    pub(super) fn new(seed: u64, number: u64, place: u64) -> Self {
        let of_sample = mixed(mixed(seed).wrapping_add(number));
        Self(mixed(of_sample.wrapping_add(place)))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mixed(self.0)
    }

    /// Returns a number that is uniform in [−1, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        // The number has 53 bits: all multiples of 2⁻⁵² in the interval are equally likely.
        (self.next() >> 11) as f64 * (2.0 * f64::EPSILON / 2.0) - 1.0
    }

    /// Returns a vector that is uniform in the unit ball of one, two or three dimensions. The other
    /// components are zero.
    pub(super) fn ball(&mut self, dimensions: usize) -> [f64; 3] {
        loop {
            let point: [f64; 3] =
                std::array::from_fn(|k| if k < dimensions { self.uniform() } else { 0.0 });
            // At least half of the points of the cube are in the ball.
            if point.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                return point;
            }
        }
    }
}

/// The output function of SplitMix64.
fn mixed(state: u64) -> u64 {
    let mut z = state.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: u64 = 20_000;

    /// Moments of the uniform distribution in a ball of d dimensions: the mean is zero, and E|x|² =
    /// d/(d + 2). Five standard deviations of the mean of 20000 numbers of size one are 0.035.
    #[test]
    fn displacements_fill_the_ball_evenly() {
        for d in 1..=3 {
            let (mut mean, mut square) = ([0.0; 3], 0.0);
            for k in 0..N {
                let x = Stream::new(7, k, 3).ball(d);
                let size = x.iter().map(|x| x * x).sum::<f64>();
                assert!(size <= 1.0 && x[d..].iter().all(|x| *x == 0.0));
                square += size / N as f64;
                mean.iter_mut().zip(x).for_each(|(m, x)| *m += x / N as f64);
            }
            assert!(mean.iter().all(|m| m.abs() < 0.035), "{mean:?}");
            assert!(
                (square - d as f64 / (d as f64 + 2.0)).abs() < 0.02,
                "{square}"
            );
        }
    }

    #[test]
    fn streams_of_seeds_samples_and_data_are_unrelated() {
        let pairs = [
            ([1, 2, 3], [2, 1, 3]),
            ([1, 2, 3], [1, 3, 2]),
            ([0, 0, 0], [0, 0, 1]),
        ];
        for (a, b) in pairs {
            let draw = |[seed, number, place]: [u64; 3]| Stream::new(seed, number, place).uniform();
            assert_ne!(draw(a), draw(b));
        }
        let product = |k| Stream::new(1, k, 0).uniform() * Stream::new(1, k, 1).uniform();
        let correlation = (0..N).map(product).sum::<f64>() / N as f64;
        // The limit is five standard deviations. The product of two numbers has the variance 1/9.
        assert!(
            correlation.abs() < 5.0 / 3.0 / (N as f64).sqrt(),
            "{correlation}"
        );
    }
}
