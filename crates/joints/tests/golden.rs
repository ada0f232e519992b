//! Compares Φ, velocity rows and forces with tables that were computed by hand. There is one file
//! for each definition in `tests/golden`; those for space are in the folder `space`. These tests
//! are necessary because checks of derivatives do not detect a wrong sign, a wrong axis or a
//! missing row.
//!
//! A file contains at least three poses with `phi`, `velocity` (C·v − b) or `q`; the derivation of
//! the values is in the comments of the file.

mod table;

use std::collections::BTreeSet;

use approx::{abs_diff_eq, assert_abs_diff_eq};
use pfaff_joints::{Constraint, Definition, Force, ForceElement, Plane, Space3, Visitor};
use table::{Golden, Tabled, read};

/// Smallest number of poses that are sufficient to determine Φ, a velocity row or a force.
const POSES: usize = 3;

/// Values in the tables are at most about 100, and the computed values contain about ten rounding
/// errors.
const TOLERANCE: f64 = 1e-13;

#[test]
fn every_definition_agrees_with_its_table() {
    let mut tables = Tables::default();
    pfaff_joints::plane_constraints(&mut tables);
    pfaff_joints::plane_forces(&mut tables);
    tables.are_complete::<Plane>();
    let mut tables = Tables::default();
    pfaff_joints::space3::constraints(&mut tables);
    pfaff_joints::space3::forces(&mut tables);
    tables.are_complete::<Space3>();
}

#[derive(Default)]
struct Tables {
    seen: BTreeSet<String>,
}

impl Tables {
    fn are_complete<S: Tabled>(&self) {
        assert_eq!(
            self.seen,
            table::files::<S>(),
            "files without a definition, or the other way round"
        );
    }
}

impl<S: Tabled> Visitor<S> for Tables {
    fn constraint<K: Constraint<S>>(&mut self) {
        self.drive::<K>();
        K::visit_drives(self);
    }

    fn drive<K: Constraint<S>>(&mut self) {
        let name = K::SPEC.common.name;
        let poses = read::<S>(name);
        let pinned = |g: &&Golden| {
            (K::SPEC.holonomic == 0 || g.phi.is_some())
                && (K::SPEC.nonholonomic() == 0 || g.velocity.is_some())
        };
        assert!(
            poses.iter().filter(pinned).count() >= POSES,
            "{name}: fewer than {POSES} poses"
        );
        for (number, golden) in poses.iter().enumerate() {
            constraint::<K, S>(golden, &format!("{name}, pose {}", number + 1));
        }
        self.seen.insert(table::file_name(name));
    }

    fn force<K: Force<S>>(&mut self) {
        let name = K::SPEC.common.name;
        let poses = read::<S>(name);
        let pinned = poses.iter().filter(|g| g.q.is_some()).count();
        assert!(pinned >= POSES, "{name}: fewer than {POSES} poses");
        for (number, golden) in poses.iter().enumerate() {
            force::<K, S>(golden, &format!("{name}, pose {}", number + 1));
        }
        self.seen.insert(table::file_name(name));
    }
}

fn constraint<K: Constraint<S>, S: Tabled>(golden: &Golden, place: &str) {
    assert!(golden.q.is_none(), "{place}: `q` is for forces");
    let mut k = K::from_arguments(&golden.arguments::<S>(&K::SPEC.common)).expect(place);
    let (x, v, mut f) = (golden.x::<S>(), golden.v::<S>(), golden.f());
    if K::SPEC.turning {
        let angle = f.pop().unwrap_or_default();
        f.extend(turn(angle));
    }
    k.initialise(&golden.start::<S>());
    requirements(golden, place, |r| k.requirement(r, &golden.start::<S>()));
    let m = K::SPEC.rows.len();
    let mut out = vec![0.0; m];
    let phi = &mut out[..K::SPEC.holonomic];
    k.phi(&x, &f, phi);
    compare(golden.phi.as_ref(), phi, place, "Φ");
    let mut c = vec![0.0; K::SPEC.c.len()];
    k.c_constant(&mut c);
    k.c(&x, &f, &mut c);
    let mut b = vec![0.0; m];
    k.b(&x, &f, &mut b);
    let mut velocity: Vec<f64> = b.iter().map(|b| -b).collect();
    for (entry, c) in K::SPEC.c.iter().zip(&c) {
        velocity[entry.row] += c * v[S::N_DOF * entry.slot + entry.dof];
    }
    compare(golden.velocity.as_ref(), &velocity, place, "C·v − b");
    let twists: Vec<_> = v.chunks(S::N_DOF).map(S::twist).collect();
    k.gamma(&x, &twists, &f, &mut out);
    compare(golden.gamma.as_ref(), &out, place, "Γ");
    let mut map = vec![0.0; K::SPEC.wrench.len()];
    k.wrench(&x, &f, &mut map);
    let mut wrench = vec![0.0; S::N_DOF];
    let lambda = golden.lambda();
    if golden.wrench.is_some() {
        assert_eq!(
            lambda.len(),
            m,
            "{place}: `wrench` needs one `lambda` for each row"
        );
        for (&[component, row], w) in K::SPEC.wrench.iter().zip(&map) {
            wrench[component] += w * lambda[row];
        }
    }
    compare(golden.wrench.as_ref(), &wrench, place, "the wrench");
    let mut component = vec![0.0; if K::SPEC.component.is_some() { m } else { 0 }];
    k.component(&x, &f, &mut component);
    compare(
        golden.component.as_ref(),
        &component,
        place,
        "the component",
    );
    let point = k.place(&x);
    compare(golden.place.as_ref(), point.as_ref(), place, "the place");
}

/// Returns the cosine and the sine of an angle, each with two derivatives.
fn turn([f, f_t, f_tt]: [f64; 3]) -> [[f64; 3]; 2] {
    let (sin, cos) = f.sin_cos();
    [
        [cos, -sin * f_t, -cos * f_t * f_t - sin * f_tt],
        [sin, cos * f_t, cos * f_tt - sin * f_t * f_t],
    ]
}

fn force<K: Force<S>, S: Tabled>(golden: &Golden, place: &str) {
    assert!(
        golden.only_force(),
        "{place}: only `q` and `requirements` are for forces"
    );
    let mut k = K::from_arguments(&golden.arguments::<S>(&K::SPEC.common)).expect(place);
    k.initialise(&golden.start::<S>());
    requirements(golden, place, |r| k.requirement(r, &golden.start::<S>()));
    let mut out = vec![0.0; K::SPEC.q.len()];
    let v = golden.v::<S>();
    let twists: Vec<_> = v.chunks(S::N_DOF).map(S::twist).collect();
    k.q(&golden.x::<S>(), &twists, &golden.f(), &mut out);
    let mut q = vec![0.0; S::N_DOF * K::SPEC.common.slots.len()];
    for (&at, value) in K::SPEC.q.iter().zip(&out) {
        q[at] = *value;
    }
    compare(golden.q.as_ref(), &q, place, "Q");
}

fn compare(expected: Option<&Vec<table::Scalar>>, found: &[f64], place: &str, what: &str) {
    let Some(expected) = expected else { return };
    let expected: Vec<f64> = expected.iter().map(table::Scalar::value).collect();
    assert!(
        abs_diff_eq!(found, &expected[..], epsilon = TOLERANCE),
        "{place}: {what} = {found:?}, by hand {expected:?}"
    );
}

fn requirements(golden: &Golden, place: &str, holds: impl Fn(usize) -> bool) {
    if let Some(expected) = &golden.requirements {
        let found: Vec<bool> = (0..expected.len()).map(holds).collect();
        assert_eq!(&found, expected, "{place}: requirements");
    }
}

/// The force of a spring with free length zero is linear in d, also if the points of the spring
/// coincide. Then ∂Q/∂x is the stiffness, although the direction of d is not defined.
#[test]
fn a_spring_of_free_length_zero_keeps_its_stiffness_at_length_zero() {
    use pfaff_joints::generated::SpringDamper;
    use pfaff_joints::{Argument, Pose, Twist};
    let number = |n| Argument::Numbers(vec![n]);
    let origin = Argument::Pair([0.0, 0.0]);
    let arguments = [
        origin.clone(),
        origin,
        number(3.0),
        number(0.0),
        number(0.0),
    ];
    let mut spring = SpringDamper::from_arguments(&arguments).expect("all values are in range");
    let x = [Pose::new(1.0, 2.0, 0.0); 2];
    spring.initialise(&x);
    let mut out = vec![0.0; SpringDamper::SPEC.dq_dx.len()];
    spring.dq_dx(&x, &[Twist::zero(); 2], &[], &mut out);
    let entry = |at: [usize; 2]| {
        let k = SpringDamper::SPEC.dq_dx.iter().position(|e| *e == at);
        k.map_or(0.0, |k| out[k])
    };
    let found = [0, 1].map(|r| [0, 1, 3, 4].map(|c| entry([r, c])));
    let stiffness = [[-3.0, 0.0, 3.0, 0.0], [0.0, -3.0, 0.0, 3.0]];
    assert_abs_diff_eq!(
        found.as_flattened(),
        stiffness.as_flattened(),
        epsilon = TOLERANCE
    );
}
