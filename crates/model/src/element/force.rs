//! A force with its indices in the mechanism.

use joints::Recorded;
use joints::spec::ForceSpec;

use super::recorded::RecordedSlots;
use super::slots::{Site, Slots};
use super::{AnyForce, Bodies, with};
use crate::law::DriveForce;

/// A force with its indices in the mechanism.
#[derive(Clone)]
pub(crate) struct PlacedForce {
    pub(crate) name: String,
    element: AnyForce,
    pub(crate) site: Site,
    /// Column of Q for each value of the kernel; `None` for the ground.
    pub(crate) columns: Vec<Option<usize>>,
}

impl PlacedForce {
    pub(crate) fn new(name: &str, element: AnyForce, site: Site) -> Self {
        let columns = element.spec().q.iter().map(|&k| site.column(k));
        Self {
            name: name.to_owned(),
            columns: columns.collect(),
            element,
            site,
        }
    }

    pub(crate) fn kernels(&self) -> &AnyForce {
        &self.element
    }

    pub(crate) fn spec(&self) -> &'static ForceSpec {
        self.element.spec()
    }

    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        self.element.points()
    }

    pub(crate) fn is_law(&self) -> bool {
        with!(AnyForce, &self.element, element, _S => element.is_law())
    }

    pub(crate) fn initialise(&mut self, bodies: &Bodies) {
        with!(AnyForce, &mut self.element, element, S => {
            element.initialise(&self.site.poses::<S, f64>(bodies));
        });
    }

    /// The first requirement of its definition that is not met at these poses.
    pub(crate) fn unmet_requirement(&self, bodies: &Bodies) -> Option<&'static str> {
        let words = self.spec().common.requirements;
        let unmet = with!(AnyForce, &self.element, element, S => {
            let x = self.site.poses::<S, f64>(bodies);
            (0..words.len()).find(|&k| !element.requirement(k, &x))
        })?;
        Some(words[unmet])
    }

    #[inline]
    pub(crate) fn q(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.q(x, v, f, out);
        });
    }

    pub(crate) fn dq_dx(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dx(x, v, f, out);
        });
    }

    pub(crate) fn dq_dv(&self, s: &Slots, out: &mut [f64]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.dq_dv(x, v, f, out);
        });
    }

    /// The force along the measure of a drive by a law.
    pub(crate) fn drive(&self, s: &Slots) -> Option<DriveForce> {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = (self.site.x::<S>(s), self.site.v::<S>(&s.rates), self.site.f(s));
            element.drive(x, v, f)
        })
    }

    pub(crate) fn recorded_q(&self, at: &RecordedSlots, out: &mut [Recorded]) {
        with!(AnyForce, &self.element, element, S => {
            let (x, v, f) = at.of::<S>(&self.site);
            element.recorded().q(&x, &v, f, out);
        });
    }
}
