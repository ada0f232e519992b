//! Derivatives along a curve, by two methods independent of the kernels: dual numbers, and central
//! differences with Richardson extrapolation.

use num_dual::Dual2_64;

use crate::block::Block;
use crate::kernels::KernelNumber;
use crate::number::Dual;

/// A block that depends on one number τ; its derivatives are computed at τ = 0.
pub(crate) trait Curve {
    /// The block at τ.
    fn at<D: KernelNumber>(&self, tau: D) -> Block<D>;
}

/// A method of differentiation.
pub(crate) trait Differentiate {
    /// `d/dτ` at 0.
    fn first(curve: &impl Curve) -> Block;
    /// `d²/dτ²` at 0.
    fn second(curve: &impl Curve) -> Block;
}

/// Dual numbers: exact up to rounding errors.
pub(crate) struct DualNumbers;

impl Differentiate for DualNumbers {
    fn first(curve: &impl Curve) -> Block {
        let tau = Dual(Dual2_64::new(0.0, 1.0, 0.0));
        curve.at(tau).map(|e| e.0.v1)
    }

    fn second(curve: &impl Curve) -> Block {
        let tau = Dual(Dual2_64::new(0.0, 1.0, 0.0));
        curve.at(tau).map(|e| e.0.v2)
    }
}

/// Central differences over halved steps, extrapolated to step zero. The error of a central
/// difference is a series in h², so each extrapolation removes one power. The result is the value
/// of the whole table that is closest to both values from which it was computed.
pub(crate) struct Differences;

/// The largest step, as a power of two: about a tenth of the sizes in ordinary cases.
const LARGEST: i32 = -3;
/// Number of steps of a first difference, down to 2⁻¹²: forces near a vanishing length need small
/// steps.
const FIRST_STEPS: i32 = 10;
/// Number of steps of a second difference, down to 2⁻⁷: the rounding error grows as 1/h², to at
/// most 1e-11.
const SECOND_STEPS: i32 = 5;
/// Number of extrapolations per step: with more, the rounding error grows faster than the
/// truncation error decreases.
const ORDERS: usize = 4;

impl Differentiate for Differences {
    fn first(curve: &impl Curve) -> Block {
        by_differences(|h| curve.at(h))
    }

    fn second(curve: &impl Curve) -> Block {
        let middle = curve.at(0.0);
        extrapolate(SECOND_STEPS, |h| {
            let mut sum = curve.at(h);
            sum.update(&middle, |a, m| a - m);
            let mut before = curve.at(-h);
            before.update(&middle, |b, m| b - m);
            sum.update(&before, |a, b| (a + b) / (h * h));
            sum
        })
    }
}

/// The first derivative at 0 of a block of one plain number.
pub(crate) fn by_differences(block: impl Fn(f64) -> Block) -> Block {
    extrapolate(FIRST_STEPS, |h| {
        let mut difference = block(h);
        difference.update(&block(-h), |a, b| (a - b) / (2.0 * h));
        difference
    })
}

fn extrapolate(steps: i32, difference: impl Fn(f64) -> Block) -> Block {
    let mut best = difference(2f64.powi(LARGEST));
    let mut least = f64::INFINITY;
    let mut previous = vec![best.clone()];
    for step in 1..steps {
        let mut row = vec![difference(2f64.powi(LARGEST - step))];
        for order in 1..=previous.len().min(ORDERS) {
            let gain = 4f64.powi(i32::try_from(order).unwrap_or(0)) - 1.0;
            let (fine, coarse) = (&row[order - 1], &previous[order - 1]);
            let next = fine.zip(coarse, |f, c| f + (f - c) / gain);
            let change = next.difference(fine).max(next.difference(coarse));
            if change < least {
                (best, least) = (next.clone(), change);
            }
            row.push(next);
        }
        previous = row;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `sin(1 + τ)`
    struct Sine;
    impl Curve for Sine {
        fn at<D: KernelNumber>(&self, tau: D) -> Block<D> {
            Block::column(vec![(D::from(1.0) + tau).sin_cos().0])
        }
    }

    #[test]
    fn both_ways_differentiate_the_sine() {
        let (sin, cos) = 1f64.sin_cos();
        assert!((DualNumbers::first(&Sine).get(0, 0) - cos).abs() <= f64::EPSILON);
        assert!((DualNumbers::second(&Sine).get(0, 0) + sin).abs() <= f64::EPSILON);
        // The rounding error of a difference is about ε/h, of a second difference ε/h².
        assert!((Differences::first(&Sine).get(0, 0) - cos).abs() <= 1e-12);
        assert!((Differences::second(&Sine).get(0, 0) + sin).abs() <= 1e-11);
    }
}
