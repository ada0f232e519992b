//! A constraint with its indices in the mechanism.

use std::ops::Range;

use joints::space3::{Pose, Twist};
use joints::spec::ConstraintSpec;
use joints::{Magnitude, SlopedOutputs, Slopes, Space3};

use super::slots::{Kinematics, Rates, Site, Slots};
use super::{AnyConstraint, Bodies, BodySpace, stored, with};
use crate::rows::RowRanges;

/// A constraint in the axes of the coordinates of its bodies. These axes may be principal axes.
#[derive(Clone)]
pub(crate) struct FramedConstraint {
    element: AnyConstraint,
    /// Axes u, v and w of the joint, fixed in the first body, in the axes of the body frame.
    axes: Option<[[f64; 3]; 3]>,
}

impl FramedConstraint {
    /// Creates the constraint from its description; `turn` transforms it to the axes of the
    /// coordinates of its bodies.
    pub(crate) fn new(mut element: AnyConstraint, turn: impl FnOnce(&mut AnyConstraint)) -> Self {
        let axes = with!(AnyConstraint, &element, element, _S => element.axes());
        turn(&mut element);
        Self { element, axes }
    }

    pub(crate) fn kernels(&self) -> &AnyConstraint {
        &self.element
    }

    pub(crate) fn kernels_mut(&mut self) -> &mut AnyConstraint {
        &mut self.element
    }
}

/// A constraint with its indices in the mechanism. The kernels need the poses of the bodies, and
/// also the velocities if the kernels depend on velocities. `out` is overwritten.
#[derive(Clone)]
pub(crate) struct PlacedConstraint {
    framed: FramedConstraint,
    pub(crate) site: Site,
    /// Range of the entries of C of this constraint in the work space.
    pub(crate) entries: Range<usize>,
    /// Indices of the varying entries, relative to `entries`.
    pub(crate) varying: Vec<usize>,
    pub(crate) rows: RowRanges,
    /// Tolerance of the data of the constraint (m), if stated.
    pub(crate) tolerance: Option<f64>,
}

impl PlacedConstraint {
    /// Returns a constraint whose rows are not yet numbered.
    pub(crate) fn new(
        framed: FramedConstraint,
        site: Site,
        entries: Range<usize>,
        tolerance: Option<f64>,
    ) -> Self {
        let all = framed.element.spec().c.iter().enumerate();
        let varying = all.filter(|(_, e)| !e.constant).map(|(at, _)| at);
        Self {
            varying: varying.collect(),
            framed,
            site,
            entries,
            rows: RowRanges::default(),
            tolerance,
        }
    }

    pub(crate) fn kernels(&self) -> &AnyConstraint {
        &self.framed.element
    }

    pub(crate) fn framed(&self) -> &FramedConstraint {
        &self.framed
    }

    /// Returns the axes u, v and w of the joint, fixed in the first body, in the axes of the body
    /// frame.
    pub(crate) fn axes(&self) -> Option<[[f64; 3]; 3]> {
        self.framed.axes
    }

    /// Returns three unit vectors in ground axes for each of the first two bodies. The vectors are
    /// the axes that the rows keep parallel.
    pub(crate) fn parallel_axes(&self, s: &Slots) -> Option<[[[f64; 3]; 3]; 2]> {
        let element = &self.framed.element;
        let own = with!(AnyConstraint, element, element, _S => element.parallel_axes())?;
        let poses = self.site.x::<Space3>(s);
        Some([0, 1].map(|slot| own[slot].map(|axis| poses[slot].direction_to_global(axis))))
    }

    pub(crate) fn spec(&self) -> &'static ConstraintSpec {
        self.framed.element.spec()
    }

    /// Returns whether the block of C of this constraint depends on the configuration.
    pub(crate) fn has_varying_entries(&self) -> bool {
        !self.varying.is_empty()
    }

    /// Returns whether b and Φt of the rows may differ from zero.
    pub(crate) fn depends_on_time(&self) -> bool {
        self.spec().rheonomic
    }

    /// Returns whether Γ of the rows may differ from zero. In rows without Γ, C is constant, so
    /// `C·v̇ = 0`.
    pub(crate) fn has_gamma(&self) -> bool {
        self.has_varying_entries() || self.depends_on_time()
    }

    /// Returns the cosine, sine and rate of an unwrapped angle in space for the given poses and
    /// twists of the bodies.
    pub(crate) fn counted(&self, number: usize, x: &[Pose], v: &[Twist]) -> [f64; 3] {
        match &self.framed.element {
            AnyConstraint::Space3(element) => element.turned(number, x, v),
            AnyConstraint::Plane(_) => [1.0, 0.0, 0.0],
        }
    }

    /// Replaces the stored values, in the order of the specification.
    pub(crate) fn set_data(&mut self, numbers: &[f64]) {
        with!(AnyConstraint, &mut self.framed.element, element, _S => element.set_data(numbers));
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        with!(AnyConstraint, &mut self.framed.element, element, S => {
            element.initialise(&self.site.poses::<S, f64>(bodies));
        });
    }

    /// Returns the first requirement of the definition that these poses do not satisfy.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let words = self.spec().common.requirements;
        let unmet = with!(AnyConstraint, &self.framed.element, element, S => {
            let x = self.site.poses::<S, f64>(bodies);
            (0..words.len()).find(|&k| !element.requirement(k, &x))
        })?;
        Some(words[unmet])
    }

    /// Computes Φ of the holonomic rows of the constraint.
    #[inline]
    pub(crate) fn phi(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.phi(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn c(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.c(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn b(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.b(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn gamma(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.gamma(x, v, f, out);
        });
    }

    #[inline]
    pub(crate) fn wrench(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.wrench(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    #[inline]
    pub(crate) fn component(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.component(self.site.x::<S>(s), self.site.f(s), out);
        });
    }

    /// Returns the reference point of the reaction (m), in ground axes.
    pub(crate) fn place(&self, s: &Slots) -> [f64; 3] {
        with!(AnyConstraint, &self.framed.element, element, S => {
            S::point(element.place(self.site.x::<S>(s)))
        })
    }

    /// Returns the origin of the first body (m), in ground axes.
    pub(crate) fn first_origin(&self, s: &Slots) -> [f64; 3] {
        with!(AnyConstraint, &self.framed.element, _element, S => {
            S::first_origin(self.site.x::<S>(s))
        })
    }

    pub(crate) fn d_force_dx(&self, s: &Slots, lambda: &[f64], out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.d_force_dx(self.site.x::<S>(s), self.site.f(s), lambda, out);
        });
    }

    pub(crate) fn d_residual_dx(&self, s: &Slots, a: &Rates, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_residual_dx(x, v, self.site.v::<S>(a), f, out);
        });
    }

    pub(crate) fn d_gamma_dv(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_gamma_dv(x, v, f, out);
        });
    }

    pub(crate) fn d_velocity_dx(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyConstraint, &self.framed.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.d_velocity_dx(x, v, f, out);
        });
    }

    /// Returns the derivatives of Φ with respect to the stored values.
    pub(crate) fn slopes_of_phi(&self, s: &Slots) -> Slopes {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.slopes(self.site.x::<S>(s), self.site.f(s), SlopedOutputs::Phi)
        })
    }

    /// Returns the derivatives of C with respect to the stored values.
    pub(crate) fn slopes_of_c(&self, s: &Slots) -> Slopes {
        with!(AnyConstraint, &self.framed.element, element, S => {
            element.slopes(self.site.x::<S>(s), self.site.f(s), SlopedOutputs::C)
        })
    }

    /// Returns the derivatives of Φ, of C, and of Γ at the current velocities, with respect to the
    /// stored values.
    pub(crate) fn slopes(&self, s: &Slots) -> Slopes {
        with!(AnyConstraint, &self.framed.element, element, S => {
            let v = self.site.v::<S>(&s.rates);
            element.slopes(self.site.x::<S>(s), self.site.f(s), SlopedOutputs::All(v))
        })
    }

    /// Computes the sizes of the terms of C.
    pub(crate) fn magnitude_c(&self, s: &Slots, out: &mut [Magnitude]) {
        let jets = self.site.f(s).iter();
        let f: Vec<[Magnitude; 3]> = jets.map(|jet| jet.map(Magnitude::from)).collect();
        with!(AnyConstraint, &self.framed.element, element, S => {
            let x: Vec<_> = self.site.x::<S>(s).iter().map(S::magnitude).collect();
            element.programs().of(&stored(element.as_ref())).c::<S>(&x, &f, out);
        });
    }
}
