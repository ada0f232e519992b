//! A force with its indices in the mechanism.

use joints::space3::{Pose, Twist};
use joints::spec::ForceSpec;
use joints::{RecordedNumber, Space3};

use super::recorded::RecordedSlots;
use super::slots::{Site, Slots};
use super::turned::TurnedSlots;
use super::{AnyForce, Bodies, ForceKernels, with};
use crate::body::BodyRef;
use crate::law::{DriveForce, Law, UndefinedValue};

/// A force with its indices in the mechanism.
#[derive(Clone)]
pub(crate) struct PlacedForce {
    pub(crate) name: String,
    element: AnyForce,
    pub(crate) site: Site,
    /// Rotations between the axes of the kernels and the axes of the coordinates of the bodies.
    turned: Option<TurnedSlots>,
    /// Column of Q for each value of the kernel; `None` for the ground.
    pub(crate) columns: Vec<Option<usize>>,
    /// Number of values of controllers among the arguments of the kernels.
    pub(crate) signals: usize,
}

impl PlacedForce {
    pub(crate) fn new(
        name: &str,
        element: AnyForce,
        site: Site,
        turned: Option<TurnedSlots>,
    ) -> Self {
        let columns = match &turned {
            Some(turned) => turned.columns().map(|k| site.column(k)).collect(),
            None => {
                let columns = element.spec().q.iter();
                columns.map(|&k| site.column(k)).collect()
            }
        };
        Self {
            name: name.to_owned(),
            columns,
            element,
            site,
            turned,
            signals: 0,
        }
    }

    pub(crate) fn kernels(&self) -> &AnyForce {
        &self.element
    }

    pub(crate) fn spec(&self) -> &'static ForceSpec {
        self.element.spec()
    }

    pub(crate) fn turned(&self) -> Option<&TurnedSlots> {
        self.turned.as_ref()
    }

    /// Returns the pattern (row, column of the block) of `∂Q/∂x`.
    pub(crate) fn pattern_dx(&self) -> &[[usize; 2]] {
        let turned = self.turned.as_ref();
        turned.map_or(self.spec().dq_dx, TurnedSlots::pairs)
    }

    /// Returns the pattern (row, column of the block) of `∂Q/∂v`.
    pub(crate) fn pattern_dv(&self) -> &[[usize; 2]] {
        let turned = self.turned.as_ref();
        turned.map_or(self.spec().dq_dv, TurnedSlots::pairs)
    }

    /// Returns the points at which the force acts, with their bodies. The points are in the axes of
    /// the coordinates of these bodies.
    pub(crate) fn points(&self) -> Vec<(BodyRef, [f64; 3])> {
        let own = |slot: usize, point: [f64; 3]| {
            let turned = self.turned.as_ref();
            turned.map_or(point, |turned| turned.own_point(slot, point))
        };
        let slots = self.spec().common.slots_of_points();
        let points = slots.zip(self.element.points());
        let placed = points.map(|(slot, p)| (self.site.bodies[slot], own(slot, p)));
        placed.collect()
    }

    /// Returns the kernels in space and the transformation of their axes; `None` if the kernels use
    /// the same axes as the coordinates of the bodies.
    fn between(&self) -> Option<(&TurnedSlots, &dyn ForceKernels<Space3>)> {
        match (&self.turned, &self.element) {
            (Some(turned), AnyForce::Space3(kernels)) => Some((turned, kernels.as_ref())),
            _ => None,
        }
    }

    /// Returns the cosine, sine and rate of an unwrapped angle in space for the given poses and
    /// twists of the bodies.
    pub(crate) fn counted(&self, number: usize, x: &[Pose], v: &[Twist]) -> [f64; 3] {
        match (&self.turned, &self.element) {
            (Some(turned), AnyForce::Space3(kernels)) => {
                turned.with_frames((x, v), |x, v| kernels.turned(number, x, v))
            }
            (None, AnyForce::Space3(kernels)) => kernels.turned(number, x, v),
            (_, AnyForce::Plane(_)) => [1.0, 0.0, 0.0],
        }
    }

    pub(crate) fn is_law(&self) -> bool {
        with!(AnyForce, &self.element, element, _S => element.is_law())
    }

    pub(crate) fn is_called(&self) -> bool {
        self.signals > 0 || with!(AnyForce, &self.element, element, _S => element.is_called())
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        if let (Some(turned), AnyForce::Space3(element)) = (&self.turned, &mut self.element) {
            let mut x = self.site.poses::<Space3, f64>(bodies);
            turned.poses(&mut x);
            return element.initialise(&x);
        }
        with!(AnyForce, &mut self.element, element, S => {
            element.initialise(&self.site.poses::<S, f64>(bodies));
        });
    }

    /// Returns the first requirement of the definition that these poses do not satisfy.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let words = self.spec().common.requirements;
        let unmet = match self.between() {
            Some((turned, kernels)) => {
                let mut x = self.site.poses::<Space3, f64>(bodies);
                turned.poses(&mut x);
                (0..words.len()).find(|&k| !kernels.requirement(k, &x))
            }
            None => with!(AnyForce, &self.element, element, S => {
                let x = self.site.poses::<S, f64>(bodies);
                (0..words.len()).find(|&k| !element.requirement(k, &x))
            }),
        }?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn q(&self, s: &Slots, out: &mut [f64]) {
        if let Some((turned, kernels)) = self.between() {
            let out = &mut out[..self.columns.len()];
            return turned.q(kernels, self.site.in_space(s), self.site.f(s), out);
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.q(x, v, f, out);
        });
    }

    /// Adds this multiple of the contribution to Q.
    pub(crate) fn add_q(&self, (s, block): (&Slots, &mut [f64]), share: f64, q: &mut [f64]) {
        self.q(s, block);
        for (column, value) in self.columns.iter().zip(block) {
            if let Some(column) = column {
                q[*column] += share * *value;
            }
        }
    }

    /// Returns the drive with a force or torque of one unit, in place of its force law.
    pub(crate) fn with_unit_law(&self) -> Self {
        let mut unit = self.clone();
        with!(AnyForce, &mut unit.element, element, _S => {
            if let Some(replaced) = element.with_law(&Law::unit()) {
                *element = replaced;
            }
        });
        unit
    }

    pub(crate) fn dq_dx(&self, s: &Slots, out: &mut [f64]) {
        if let Some((turned, kernels)) = self.between() {
            let (pattern, f) = (kernels.spec().dq_dx, self.site.f(s));
            let kernel = |x: &[Pose], v: &[Twist], out: &mut [f64]| kernels.dq_dx(x, v, f, out);
            return turned.derivative(pattern, self.site.in_space(s), kernel, out);
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dx(x, v, f, out);
        });
    }

    pub(crate) fn dq_dv(&self, s: &Slots, out: &mut [f64]) {
        if let Some((turned, kernels)) = self.between() {
            let (pattern, f) = (kernels.spec().dq_dv, self.site.f(s));
            let kernel = |x: &[Pose], v: &[Twist], out: &mut [f64]| kernels.dq_dv(x, v, f, out);
            return turned.derivative(pattern, self.site.in_space(s), kernel, out);
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dv(x, v, f, out);
        });
    }

    /// Returns the force along the joint coordinate if the element is a drive with a force law.
    pub(crate) fn drive(&self, s: &Slots) -> Option<DriveForce> {
        if let Some((turned, kernels)) = self.between() {
            let f = self.site.f(s);
            return turned.with_frames(self.site.in_space(s), |x, v| kernels.drive(x, v, f));
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.drive(x, v, f)
        })
    }

    /// Returns the number of states of the force law.
    pub(crate) fn n_states(&self) -> usize {
        self.element.n_states()
    }

    /// Computes the rates of the states of the force law.
    pub(crate) fn state_rates(&self, s: &Slots, out: &mut [f64]) {
        if let Some((turned, kernels)) = self.between() {
            let (f, at) = (self.site.f(s), self.site.in_space(s));
            return turned.with_frames(at, |x, v| kernels.state_rates(x, v, f, out));
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.state_rates(x, v, f, out);
        });
    }

    /// Computes the states of the force law at the start.
    pub(crate) fn first_states(&self, s: &Slots, out: &mut [f64]) {
        if let Some((turned, kernels)) = self.between() {
            let (f, at) = (self.site.f(s), self.site.in_space(s));
            return turned.with_frames(at, |x, v| kernels.first_states(x, v, f, out));
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.first_states(x, v, f, out);
        });
    }

    /// Returns the reason why the callback has no value, or `None` if it has a value.
    pub(crate) fn undefined(&self, s: &Slots) -> Option<UndefinedValue> {
        if let Some((turned, kernels)) = self.between() {
            let f = self.site.f(s);
            let at = self.site.in_space(s);
            return turned.with_frames(at, |x, v| kernels.undefined(x, v, f));
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.undefined(x, v, f)
        })
    }

    pub(crate) fn recorded_q(&self, at: &RecordedSlots, out: &mut [RecordedNumber]) {
        if let Some((turned, kernels)) = self.between() {
            let (x, v, f) = at.of::<Space3>(&self.site);
            return turned.recorded_q(kernels, (x, v), f, out);
        }
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = at.of::<S>(&self.site);
            element.recorded_q(&x, &v, f, out);
        });
    }
}
