//! The kernels of a coupling, from those of the drives of its measures.

use joints::spec::ConstraintSpec;
use joints::{Definition, Derivatives, Element, Positions, Real, Ring};

use super::Coupling;
use super::side::{At, KernelNumbers, MOST, Numbers};
use crate::element::{Kinematics, PoseOf, TwistOf};

/// Both measures at a pose, with h and its derivatives.
struct Both<T> {
    x: At<T>,
    y: At<T>,
    h: [T; 4],
}

impl<S: Kinematics> Coupling<S> {
    fn both<T: Numbers>(&self, x: &[PoseOf<S, T>], f: &[[T; 3]]) -> Both<T> {
        let [of_x, of_y] = &self.sides;
        let (at_x, at_y) = (of_x.at(&of_x.own(x), f), of_y.at(&of_y.own(x), f));
        Both {
            h: self.law.at(at_x.measure),
            x: at_x,
            y: at_y,
        }
    }

    /// Adds values of one side to entries of the row, by columns of the side.
    fn add_row<T: Ring>(
        &self,
        side: usize,
        pattern: &[[usize; 2]],
        own: impl Iterator<Item = (usize, T)>,
        out: &mut [T],
    ) {
        for (column, value) in own {
            let column = self.facts.of_side(self.sides[side].slots, column);
            if let Ok(at) = pattern.binary_search(&[0, column]) {
                out[at] = out[at] + value;
            }
        }
    }

    /// Columns of a side with the entries of its gradient.
    fn gradient<'g>(
        &'g self,
        side: usize,
        of: &'g At<f64>,
    ) -> impl Iterator<Item = (usize, f64)> + 'g {
        let n_dof = S::N_DOF;
        let entries = self.sides[side].drive.spec().c.iter();
        let columns = entries.map(move |e| n_dof * e.slot + e.dof);
        columns.zip(of.gradient)
    }
}

impl<S: Kinematics> Definition<S> for Coupling<S> {
    fn initialise(&mut self, x: &[PoseOf<S>]) {
        for side in &mut self.sides {
            let own = side.own(x);
            side.drive.initialise(&own);
            side.take_constants();
        }
    }

    fn requirement(&self, _: usize, _: &[PoseOf<S>]) -> bool {
        true
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
            side.take_constants();
        }
        let first = self.sides[1].data.end;
        let coefficients = self.law.coefficients_mut();
        let n = coefficients.len();
        coefficients.copy_from_slice(&numbers[first..first + n]);
    }
}

impl<T: Numbers, S: Kinematics> Positions<T, S> for Coupling<S> {
    fn spec(&self) -> &'static ConstraintSpec {
        &self.facts.spec
    }

    fn phi(&self, x: &[PoseOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let both = self.both(x, f);
        out[0] = both.y.measure - both.h[0];
    }

    fn c_constant(&self, _: &mut [f64]) {}

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
}

impl<T: KernelNumbers, S: Kinematics> Element<T, S> for Coupling<S> {
    fn b(&self, _: &[PoseOf<S, T>], _: &[[T; 3]], _: &mut [T]) {}

    fn gamma(&self, x: &[PoseOf<S, T>], v: &[TwistOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let both = self.both(x, f);
        let [of_x, of_y] = &self.sides;
        let own = of_x.own(v);
        let rate = of_x.times(&both.x.gradient, &own);
        let gamma_x = of_x.gamma(&of_x.own(x), &own, &both.x.f);
        let gamma_y = of_y.gamma(&of_y.own(x), &of_y.own(v), &both.y.f);
        out[0] = gamma_y - both.h[1] * gamma_x + both.h[2] * rate * rate;
    }

    fn wrench(&self, x: &[PoseOf<S, T>], f: &[[T; 3]], out: &mut [T])
    where
        T: Real,
    {
        let (side, at) = (&self.sides[1], self.both(x, f).y);
        T::all_of(side.drive.as_ref()).wrench(&side.own(x), &at.f, out);
    }

    fn component(&self, _: &[PoseOf<S, T>], _: &[[T; 3]], out: &mut [T]) {
        out[0] = T::from(1.0);
    }

    fn place(&self, x: &[PoseOf<S, T>]) -> S::Vector<T>
    where
        T: Real,
    {
        let side = &self.sides[1];
        T::all_of(side.drive.as_ref()).place(&side.own(x))
    }

    fn d_phi_dp(&self, x: &[PoseOf<S, T>], f: &[[T; 3]], lambda: &[T], out: &mut [T]) {
        let both = self.both(x, f);
        let factors = [-both.h[1] * lambda[0], lambda[0]];
        for ((side, at), factor) in self.sides.iter().zip([&both.x, &both.y]).zip(factors) {
            let kernels = T::all_of(side.drive.as_ref());
            kernels.d_phi_dp(&side.own(x), &at.f, &[factor], &mut out[side.data.clone()]);
        }
        let mut power = -lambda[0];
        for out in &mut out[self.sides[1].data.end..][..self.law.degree()] {
            power = power * both.x.measure;
            *out = power;
        }
    }
}

impl<S: Kinematics> Derivatives<f64, S> for Coupling<S> {
    fn d_force_dx(&self, x: &[PoseOf<S>], f: &[[f64; 3]], lambda: &[f64], out: &mut [f64]) {
        let both = self.both(x, f);
        let pattern = self.facts.spec.d_force_dx;
        out.fill(0.0);
        let mut add = |side: usize, [a, b]: [usize; 2], value: f64| {
            let of = |column| self.facts.of_side(self.sides[side].slots, column);
            if let Ok(at) = pattern.binary_search(&[of(a), of(b)]) {
                out[at] += value;
            }
        };
        let factors = [-both.h[1] * lambda[0], lambda[0]];
        for (k, (at, factor)) in [&both.x, &both.y].into_iter().zip(factors).enumerate() {
            let side = &self.sides[k];
            let own = side.drive.spec().d_force_dx;
            let mut values = [0.0; MOST * MOST];
            let values = &mut values[..own.len()];
            side.drive
                .d_force_dx(&side.own(x), &at.f, &[factor], values);
            own.iter()
                .zip(&*values)
                .for_each(|(&pair, &value)| add(k, pair, value));
        }
        if self.law.degree() > 1 {
            for (a, g_a) in self.gradient(0, &both.x) {
                for (b, g_b) in self.gradient(0, &both.x) {
                    add(0, [a, b], -both.h[2] * lambda[0] * g_a * g_b);
                }
            }
        }
    }

    fn d_residual_dx(
        &self,
        x: &[PoseOf<S>],
        v: &[TwistOf<S>],
        a: &[TwistOf<S>],
        f: &[[f64; 3]],
        out: &mut [f64],
    ) {
        let both = self.both(x, f);
        let pattern = self.facts.spec.d_residual_dx;
        out.fill(0.0);
        for (k, (at, factor)) in [(&both.x, -both.h[1]), (&both.y, 1.0)]
            .into_iter()
            .enumerate()
        {
            let side = &self.sides[k];
            let own = side.drive.spec().d_residual_dx;
            let mut values = [0.0; MOST];
            let values = &mut values[..own.len()];
            side.drive
                .d_residual_dx(&side.own(x), &side.own(v), &side.own(a), &at.f, values);
            let columns = own
                .iter()
                .zip(&*values)
                .map(|(&[_, b], value)| (b, factor * value));
            self.add_row(k, pattern, columns, out);
            if side.counts_turns() {
                // Of sin ε, Γ has ε·rate²; what is known of the angle moves with it.
                let rate = side.times(&at.gradient, &side.own(v));
                let known = self.gradient(k, at);
                let known = known.map(|(b, g)| (b, factor * rate * rate * g));
                self.add_row(k, pattern, known, out);
            }
        }
        if self.law.degree() > 1 {
            let [side, _] = &self.sides;
            let [second, rate] = self.accelerated(&both, x, v, a);
            let curved = both.h[2] * second + both.h[3] * rate * rate;
            let along = self.gradient(0, &both.x).map(|(k, g)| (k, -curved * g));
            self.add_row(0, pattern, along, out);
            let own = side.drive.spec().d_velocity_dx;
            let mut values = [0.0; MOST];
            let values = &mut values[..own.len()];
            side.drive
                .d_velocity_dx(&side.own(x), &side.own(v), &both.x.f, values);
            let turned = own.iter().zip(&*values);
            let turned = turned.map(|(&[_, b], value)| (b, -2.0 * both.h[2] * rate * value));
            self.add_row(0, pattern, turned, out);
        }
    }

    fn d_gamma_dv(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        let both = self.both(x, f);
        let pattern = self.facts.spec.d_gamma_dv;
        out.fill(0.0);
        for (k, (at, factor)) in [(&both.x, -both.h[1]), (&both.y, 1.0)]
            .into_iter()
            .enumerate()
        {
            let side = &self.sides[k];
            let own = side.drive.spec().d_gamma_dv;
            let mut values = [0.0; MOST];
            let values = &mut values[..own.len()];
            side.drive
                .d_gamma_dv(&side.own(x), &side.own(v), &at.f, values);
            let columns = own
                .iter()
                .zip(&*values)
                .map(|(&[_, b], value)| (b, factor * value));
            self.add_row(k, pattern, columns, out);
        }
        if self.law.degree() > 1 {
            let [side, _] = &self.sides;
            let rate = side.times(&both.x.gradient, &side.own(v));
            let along = self
                .gradient(0, &both.x)
                .map(|(k, g)| (k, 2.0 * both.h[2] * rate * g));
            self.add_row(0, pattern, along, out);
        }
    }

    fn d_velocity_dx(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        let both = self.both(x, f);
        let pattern = self.facts.spec.d_velocity_dx;
        out.fill(0.0);
        for (k, (at, factor)) in [(&both.x, -both.h[1]), (&both.y, 1.0)]
            .into_iter()
            .enumerate()
        {
            let side = &self.sides[k];
            let own = side.drive.spec().d_velocity_dx;
            let mut values = [0.0; MOST];
            let values = &mut values[..own.len()];
            side.drive
                .d_velocity_dx(&side.own(x), &side.own(v), &at.f, values);
            let columns = own
                .iter()
                .zip(&*values)
                .map(|(&[_, b], value)| (b, factor * value));
            self.add_row(k, pattern, columns, out);
        }
        if self.law.degree() > 1 {
            let [side, _] = &self.sides;
            let rate = side.times(&both.x.gradient, &side.own(v));
            let along = self
                .gradient(0, &both.x)
                .map(|(k, g)| (k, -both.h[2] * rate * g));
            self.add_row(0, pattern, along, out);
        }
    }

    fn d_residual_dp(
        &self,
        x: &[PoseOf<S>],
        v: &[TwistOf<S>],
        a: &[TwistOf<S>],
        f: &[[f64; 3]],
        lambda: &[f64],
        out: &mut [f64],
    ) {
        let both = self.both(x, f);
        let lambda = lambda[0];
        let of_sides = [(&both.x, -both.h[1] * lambda), (&both.y, lambda)];
        for (side, (at, factor)) in self.sides.iter().zip(of_sides) {
            let (own_x, own_v, own_a) = (side.own(x), side.own(v), side.own(a));
            let out = &mut out[side.data.clone()];
            side.drive
                .d_residual_dp(&own_x, &own_v, &own_a, &at.f, &[factor], out);
            if side.counts_turns() {
                let rate = side.times(&at.gradient, &own_v);
                let mut known = vec![0.0; out.len()];
                side.drive
                    .d_phi_dp(&own_x, &at.f, &[factor * rate * rate], &mut known);
                out.iter_mut().zip(known).for_each(|(out, x)| *out += x);
            }
        }
        let [side, other] = &self.sides;
        let [second, rate] = self.accelerated(&both, x, v, a);
        if self.law.degree() > 1 {
            let (own_x, own_v) = (side.own(x), side.own(v));
            let mut of_data = vec![0.0; side.data.len()];
            let curved = both.h[2] * second + both.h[3] * rate * rate;
            side.drive
                .d_phi_dp(&own_x, &both.x.f, &[-curved * lambda], &mut of_data);
            let mut of_rate = vec![0.0; side.data.len()];
            let still = [S::twist(&[0.0; 6]); 2];
            let factor = [-2.0 * both.h[2] * rate * lambda];
            side.drive
                .d_residual_dp(&own_x, &still, &own_v, &both.x.f, &factor, &mut of_rate);
            for ((out, a), b) in out[side.data.clone()].iter_mut().zip(of_data).zip(of_rate) {
                *out += a + b;
            }
        }
        // Of h'·ẍ + h''·ẋ², the powers of x.
        let x = both.x.measure;
        let mut powers = [0.0, 1.0];
        for (k, out) in out[other.data.end..][..self.law.degree()]
            .iter_mut()
            .enumerate()
        {
            let n = k as f64 + 1.0;
            *out = -lambda * (n * powers[1] * second + n * (n - 1.0) * powers[0] * rate * rate);
            powers = [powers[1], powers[1] * x];
        }
    }
}

impl<S: Kinematics> Coupling<S> {
    /// C·a − Γ of the row of x, and the rate of x.
    fn accelerated(
        &self,
        both: &Both<f64>,
        x: &[PoseOf<S>],
        v: &[TwistOf<S>],
        a: &[TwistOf<S>],
    ) -> [f64; 2] {
        let [side, _] = &self.sides;
        let own = side.own(v);
        let gamma = side.gamma(&side.own(x), &own, &both.x.f);
        let second = side.times(&both.x.gradient, &side.own(a)) - gamma;
        [second, side.times(&both.x.gradient, &own)]
    }
}
