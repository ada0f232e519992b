//! User forces that become undefined. The run must stop at the last valid state and report the time
//! and the position. It must not panic and must not reduce its steps without end.

use dynamics::{MotionOptions, RowChoice, prepare, simulate};
use joints::spec::Spec;
use joints::{
    Argument, ArgumentError, Definition, Force as Law, ForceElement, ForceSpec, Pose, Real, Twist,
};
use model::{Body, BodyRef, Description, Force, Mechanism, StartOptions};

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{combinations, moving};

/// A body that is pulled to a point at which the force is not defined.
pub(super) const FAMILY: Family = Family {
    name: "not-finite",
    about: "a body pulled by √(1 − x) N, which is NaN beyond x = 1 m: stopped there, with all rows before kept and the quantity named",
    cases,
};

/// The body starts from rest at x = 0 and reaches x = 1 with `ẋ²/2 = ∫√(1 − x) dx = 2/3` at the
/// time `t = ∫₀¹ dx/√(4/3·(1 − (1 − x)^(3/2)))`, before this end time.
const T_END: f64 = 10.0;

fn cases() -> Vec<Case> {
    let base = MotionOptions {
        output_step: 0.01,
        ..MotionOptions::to(T_END)
    };
    let made = combinations(&base).into_iter().map(|options| {
        let right = Expected::refusal(&["at t = ", "the force `root` is not finite"]);
        moving("√ of a negative number", options, right, |options| {
            Ok(pulled(options))
        })
    });
    made.collect()
}

/// A force √(1 − x) along x on a body.
#[derive(Clone)]
struct Root;

impl Law for Root {
    const SPEC: ForceSpec = ForceSpec {
        turns: 0,
        common: Spec {
            name: "Root",
            scene_type: "root",
            variant: None,
            doc: "√(1 − x) along x.",
            text: "",
            slots: &["i"],
            parameters: &[],
            points_apart: false,
            bearings: false,
            requirements: &[],
        },
        q: &[0],
        dq_dx: &[[0, 0]],
        dq_dv: &[],
        dissipative: true,
        rheonomic: false,
    };

    fn from_arguments(_: &[Argument]) -> Result<Self, ArgumentError> {
        Ok(Self)
    }

    fn element<T: Real>(&self) -> &dyn ForceElement<T> {
        self
    }
}

impl Definition for Root {
    fn initialise(&mut self, _: &[Pose]) {}

    fn requirement(&self, _: usize, _: &[Pose]) -> bool {
        true
    }
}

impl<T: Real> ForceElement<T> for Root {
    fn spec(&self) -> &'static ForceSpec {
        &<Self as Law>::SPEC
    }

    fn q(&self, x: &[Pose<T>], _: &[Twist<T>], _: &[[T; 3]], out: &mut [T]) {
        out[0] = (T::from(1.0) - x[0].x).sqrt();
    }

    fn dq_dx(&self, x: &[Pose<T>], _: &[Twist<T>], _: &[[T; 3]], out: &mut [T]) {
        out[0] = T::from(-0.5) * (T::from(1.0) - x[0].x).sqrt().recip_or_zero();
    }

    fn dq_dv(&self, _: &[Pose<T>], _: &[Twist<T>], _: &[[T; 3]], _: &mut [T]) {}
}

/// Returns the error message of a run that cannot continue beyond x = 1, if its rows are finite and
/// end near x = 1.
fn pulled(options: &MotionOptions) -> Outcome {
    let description = Description {
        name: "pulled".into(),
        bodies: vec![Body {
            name: "stone".into(),
            mass: 1.0,
            inertia: 1.0,
            ..Body::default()
        }],
        forces: vec![Force {
            name: "root".into(),
            bodies: vec![BodyRef::Body(0)],
            element: Box::new(Root),
            functions: Vec::new(),
        }],
        ..Description::default()
    };
    let Ok(mechanism) = Mechanism::build(&description) else {
        return Outcome::fact(false, "not built");
    };
    let start = StartOptions::default();
    let prepared = match prepare(mechanism, &start, &RowChoice::Automatic) {
        Ok(prepared) => prepared,
        Err(e) => return Outcome::refused(e),
    };
    let (mut last, mut is_finite) = (0.0, true);
    let run = simulate(&prepared, options, |row| {
        is_finite &= row.q.iter().chain(row.v).all(|x| x.is_finite());
        last = row.q[0];
        Ok(std::ops::ControlFlow::Continue(()))
    });
    let detail = format!("rows to x = {last}");
    match run {
        // The rows before the stop must exist and be finite.
        Err(failure) if is_finite && (0.97..=1.0).contains(&last) => {
            Outcome::refused(&failure.error)
        }
        _ => Outcome::fact(false, detail),
    }
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn runs_stop_where_the_force_ends() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn a_run_that_ends_before_is_no_refusal() {
        let found = pulled(&MotionOptions::to(1.0));
        let right = Expected::refusal(&["not finite"]);
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }
}
