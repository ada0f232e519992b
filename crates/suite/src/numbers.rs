//! A sequence of pseudo-random numbers from a seed, which is the same on every machine.

/// SplitMix64 (Steele, Lea, Flood 2014, doi 10.1145/2714064.2660195).
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// Creates the sequence of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number from `low` to `high`; the upper bound is reached only by rounding.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        low + unit * (high - low)
    }

    /// Returns a number in [−1, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns an integer in 0..n.
    ///
    /// # Panics
    /// Panics if n is 0.
    pub fn below(&mut self, n: usize) -> usize {
        assert!(n > 0, "nothing is below 0");
        (self.bits() % n as u64) as usize
    }

    /// Returns an integer in low..=high.
    ///
    /// # Panics
    /// Panics if low > high.
    pub fn between(&mut self, low: i32, high: i32) -> i32 {
        assert!(low <= high, "no number lies between {low} and {high}");
        low + self.below((high - low + 1) as usize) as i32
    }

    /// Returns true with probability 1/n.
    ///
    /// # Panics
    /// Panics if n is 0.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// Returns 0..n in a random order.
    pub fn order(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }
}
