/// What directions of vectors need.
trait RecipOrZero {
    /// `1/self`, and 0 for 0.
    fn recip_or_zero(self) -> f64;
}

impl RecipOrZero for f64 {
    #[inline(always)]
    fn recip_or_zero(self) -> f64 {
        if self == 0.0 { 0.0 } else { 1.0 / self }
    }
}
