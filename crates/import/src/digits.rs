//! The finest decimal place that a file writes: half a unit of it is what its numbers are known to.
//!
//! A file does not say how many digits of its numbers count: `0.5` may be a half or a rounded
//! number. The finest place among all lengths is what its writer could tell, so half a unit of it
//! is their tolerance; the same for angles and directions.

/// The finest decimal place of numbers of one kind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Digits {
    /// Largest number of decimals that was written; `None` if no number had any.
    pub(crate) decimals: Option<i32>,
}

impl Digits {
    /// Counts the decimals of a number. Trailing zeros count: they were written.
    pub(crate) fn see(&mut self, text: &str) {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse().unwrap_or(0)),
            None => (text, 0_i32),
        };
        let nonzero = mantissa.bytes().any(|b| matches!(b, b'1'..=b'9'));
        let after = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
        let decimals = i32::try_from(after)
            .unwrap_or(i32::MAX)
            .saturating_sub(exponent);
        if nonzero && decimals > 0 {
            self.decimals = Some(self.decimals.map_or(decimals, |most| most.max(decimals)));
        }
    }

    /// Half a unit of the finest place.
    pub(crate) fn half_unit(self) -> Option<f64> {
        self.decimals.map(|decimals| 0.5 * 10_f64.powi(-decimals))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_finest_digit_counts() {
        let finest = |words: &[&str]| {
            let mut digits = Digits::default();
            words.iter().for_each(|word| digits.see(word));
            digits.decimals
        };
        assert_eq!(finest(&["0.5", "1.25", "-3"]), Some(2));
        assert_eq!(finest(&["1.5e-3", "2E2"]), Some(4));
        assert_eq!(finest(&["0.500"]), Some(3));
        assert_eq!(finest(&["0.000", "1", "0"]), None);
    }
}
