//! The kernels of a coupling, composed of the kernels of the drives of its joint coordinates.

use std::sync::Arc;

use joints::spec::ConstraintSpec;
use joints::{ConstraintKernels, Definition, Element, Programs, Reaction};

use super::Coupling;
use super::side::At;
use crate::element::{DriveScalar, Kinematics, PoseOf, TwistOf};

/// The values of both joint coordinates at a pose, with h and its derivatives.
struct MeasurePair<T> {
    x: At<T>,
    y: At<T>,
    h: [T; 4],
}

impl<S: Kinematics> Coupling<S> {
    fn both<T: DriveScalar>(&self, x: &[PoseOf<S, T>], f: &[[T; 3]]) -> MeasurePair<T> {
        let [of_x, of_y] = &self.sides;
        let (at_x, at_y) = (of_x.at(&of_x.own(x), f), of_y.at(&of_y.own(x), f));
        MeasurePair {
            h: self.law.at(at_x.measure, of_y.stored.end),
            x: at_x,
            y: at_y,
        }
    }
}

impl<S: Kinematics> Definition<S> for Coupling<S> {
    fn initialise(&mut self, x: &[PoseOf<S>]) {
        for side in &mut self.sides {
            let own = side.own(x);
            side.drive.initialise(&own);
        }
    }

    fn turned(&self, k: usize, x: &[PoseOf<S>], v: &[TwistOf<S>]) -> [f64; 3] {
        let mut turning = self.sides.iter().filter(|side| side.drive.spec().turning);
        let side = turning.nth(k);
        side.map_or([1.0, 0.0, 0.0], |side| {
            side.drive.turned(0, &side.own(x), &side.own(v))
        })
    }

    fn points(&self) -> Vec<S::Vector<f64>> {
        let sides = self.sides.iter();
        sides.flat_map(|side| side.drive.points()).collect()
    }

    fn data(&self, out: &mut [f64]) {
        for side in &self.sides {
            side.drive.data(&mut out[side.data.clone()]);
        }
        let first = self.sides[1].data.end;
        let coefficients = self.law.coefficients();
        out[first..first + coefficients.len()].copy_from_slice(coefficients);
    }

    fn set_data(&mut self, numbers: &[f64]) {
        for side in &mut self.sides {
            side.drive.set_data(&numbers[side.data.clone()]);
        }
        let first = self.sides[1].data.end;
        let coefficients = self.law.coefficients_mut();
        let n = coefficients.len();
        coefficients.copy_from_slice(&numbers[first..first + n]);
    }
}

impl<T: DriveScalar, S: Kinematics> Element<T, S> for Coupling<S> {
    fn spec(&self) -> &'static ConstraintSpec {
        &self.facts.spec
    }

    fn phi(&self, x: &[PoseOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let both = self.both(x, f);
        out[0] = both.y.measure - both.h[0];
    }

    fn c(&self, x: &[PoseOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let both = self.both(x, f);
        let factors = [-both.h[1], T::from(1.0)];
        out.fill(T::from(0.0));
        for ((side, at), factor) in self.sides.iter().zip([both.x, both.y]).zip(factors) {
            for (&entry, g) in side.entries.iter().zip(at.gradient) {
                out[entry] = out[entry] + factor * g;
            }
        }
    }

    fn gamma(&self, x: &[PoseOf<S, T>], v: &[TwistOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let both = self.both(x, f);
        let [of_x, of_y] = &self.sides;
        let rate = of_x.times(&both.x.gradient, &of_x.own(v));
        let gamma_x = of_x.gamma(&both.x, &of_x.own(x), &of_x.own(v));
        let gamma_y = of_y.gamma(&both.y, &of_y.own(x), &of_y.own(v));
        out[0] = gamma_y - both.h[1] * gamma_x + both.h[2] * rate * rate;
    }

    fn component(&self, _: &[PoseOf<S, T>], _: &[[T; 3]], out: &mut [T]) {
        out[0] = T::from(1.0);
    }
}

/// The reaction is the reaction of the drive of y.
impl<S: Kinematics> Reaction<f64, S> for Coupling<S> {
    fn wrench(&self, x: &[PoseOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        let (side, at) = (&self.sides[1], self.both(x, f).y);
        side.drive.wrench(&side.own(x), &at.f, out);
    }

    fn place(&self, x: &[PoseOf<S>]) -> S::Vector<f64> {
        let side = &self.sides[1];
        side.drive.place(&side.own(x))
    }
}

impl<S: Kinematics> ConstraintKernels<S> for Coupling<S> {
    /// Returns the operation lists of this coupling; each coupling has its own lists, because the
    /// joint coordinates differ.
    fn programs(&self) -> &Programs {
        let numbers = self.sides[1].stored.end + self.law.degree();
        self.programs
            .get_or_init(|| Arc::new(Programs::record(self, numbers)))
    }

    fn stored(&self, out: &mut Vec<f64>) {
        self.sides.iter().for_each(|side| side.drive.stored(out));
        out.extend_from_slice(self.law.coefficients());
    }

    fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64)) {
        for side in &self.sides {
            let (stored, data) = (side.stored.start, side.data.start);
            let own = &mut |place, number, slope| entry(stored + place, data + number, slope);
            side.drive.d_stored_dp(own);
        }
        let [_, last] = &self.sides;
        (0..self.law.degree()).for_each(|k| entry(last.stored.end + k, last.data.end + k, 1.0));
    }

    fn boxed(&self) -> Box<dyn ConstraintKernels<S>> {
        Box::new(self.clone())
    }
}
