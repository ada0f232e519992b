//! Finds the finest decimal place in a file. Half a unit of the finest decimal place is the
//! accuracy of the numbers.
//!
//! A file does not state how many digits of its numbers are significant: `0.5` may be an exact half
//! or a rounded number. The finest place among all lengths is the resolution of the program that
//! wrote the file, so half a unit of this place is the tolerance of lengths. The same applies to
//! angles and directions.

/// The finest decimal place of numbers of one kind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Digits {
    /// Largest number of decimals in the text; `None` if no number has decimals.
    pub(crate) decimals: Option<i32>,
}

impl Digits {
    /// Counts the decimals of a number, including trailing zeros.
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
