//! Derivatives along a curve, computed by two methods that are independent of the kernels. The
//! methods are dual numbers, and central differences with Richardson extrapolation.

use num_dual::Dual2_64;

use crate::block::Block;
use crate::kernels::KernelNumber;
use crate::number::Dual;

/// A block that depends on a scalar τ; its derivatives are computed at τ = 0.
pub(crate) trait Curve {
    /// Returns the block at τ.
    fn at<D: KernelNumber>(&self, tau: D) -> Block<D>;
}

/// A method of differentiation.
pub(crate) trait Differentiate {
    /// Returns `d/dτ` at τ = 0.
    fn first(curve: &impl Curve) -> Block;
    /// Returns `d²/dτ²` at τ = 0.
    fn second(curve: &impl Curve) -> Block;
}

/// Differentiation with dual numbers. The result is exact up to rounding errors.
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

/// Differentiation with central differences. The steps are halved, and the results are extrapolated
/// to step zero. The error of a central difference is a series in h², so each extrapolation removes
/// one term of the series. The result is the extrapolated value with the smallest difference from
/// the two values from which it was computed.
pub(crate) struct Differences;

/// The exponent of the largest step, which is a power of two. This step is about a tenth of the
/// sizes in ordinary cases.
const LARGEST: i32 = -3;
/// Number of steps for a first derivative. The smallest step is 2⁻¹². Small steps are needed for
/// forces near a length of zero.
const FIRST_STEPS: i32 = 10;
/// Number of steps for a second derivative. The smallest step is 2⁻⁷. The rounding error is
/// proportional to 1/h² and is at most 1e-11.
const SECOND_STEPS: i32 = 5;
/// Number of extrapolations for each step. With more extrapolations, the rounding error grows
/// faster than the truncation error decreases.
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

/// Computes the first derivative at 0 of a block that is a function of a number of type `f64`.
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

    /// The curve `sin(1 + τ)`.
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
        // The rounding error of a first difference is about ε/h, and that of a second difference
        // about ε/h².
        assert!((Differences::first(&Sine).get(0, 0) - cos).abs() <= 1e-12);
        assert!((Differences::second(&Sine).get(0, 0) + sin).abs() <= 1e-11);
    }
}
