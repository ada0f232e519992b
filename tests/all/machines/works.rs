//! Virtual work and equilibrium of bodies with a prescribed motion.

use super::jet::Jet;

/// A vector in space, or in the plane with z = 0.
pub(super) type Vector = [f64; 3];

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn sum(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub(super) fn times(a: f64, v: Vector) -> Vector {
    v.map(|x| a * x)
}

pub(super) fn difference(a: Vector, b: Vector) -> Vector {
    sum(a, times(-1.0, b))
}

pub(super) fn values(p: [Jet; 3]) -> Vector {
    p.map(|x| x.x)
}

/// A body: its centre of mass and its rotation about one axis of constant direction.
#[derive(Clone, Copy)]
pub(super) struct Moving {
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) axis: Vector,
    pub(super) centre: [Jet; 3],
    pub(super) angle: Jet,
}

impl Moving {
    /// A body that does not turn.
    pub(super) fn sliding(mass: f64, centre: [Jet; 3]) -> Self {
        Self {
            mass,
            inertia: 0.0,
            axis: [0.0, 0.0, 1.0],
            centre,
            angle: 0.0.into(),
        }
    }

    /// A body of the plane.
    pub(super) fn plane(mass: f64, inertia: f64, centre: [Jet; 2], angle: Jet) -> Self {
        Self {
            mass,
            inertia,
            axis: [0.0, 0.0, 1.0],
            centre: [centre[0], centre[1], 0.0.into()],
            angle,
        }
    }
}

/// A known force at a point of a body.
#[derive(Clone, Copy)]
pub(super) struct Push {
    pub(super) body: usize,
    pub(super) at: [Jet; 3],
    pub(super) force: Vector,
}

/// A machine in one configuration of its motion.
#[derive(Clone)]
pub(super) struct Machine {
    pub(super) gravity: Vector,
    pub(super) bodies: Vec<Moving>,
    pub(super) pushes: Vec<Push>,
    /// Lengths of springs with their tensions, which work on changes of the lengths.
    pub(super) springs: Vec<(Jet, f64)>,
}

impl Machine {
    /// Force and torque about a point that joints, drives and springs exert on these bodies
    /// together: Σ m·(a − g) and the change of the angular momentum, without the known forces.
    pub(super) fn needs(&self, bodies: &[usize], about: Vector) -> (Vector, Vector) {
        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
        for &k in bodies {
            let body = self.bodies[k];
            let a = body.centre.map(|x| x.dd);
            let f = times(body.mass, difference(a, self.gravity));
            let arm = difference(values(body.centre), about);
            force = sum(force, f);
            torque = sum(torque, cross(arm, f));
            torque = sum(torque, times(body.inertia * body.angle.dd, body.axis));
        }
        for push in self
            .pushes
            .iter()
            .filter(|push| bodies.contains(&push.body))
        {
            let arm = difference(values(push.at), about);
            force = difference(force, push.force);
            torque = difference(torque, cross(arm, push.force));
        }
        (force, torque)
    }
}

/// The loads along the coordinates of the drives, positive in the direction of growth, by virtual
/// work: f·δs = Σ m·(a − g)·δr + Σ J·α·δφ − Σ F·δr + Σ T·δl. Displacements are derivatives with
/// respect to one coordinate while the others are constant.
pub(super) fn drive_loads(motion: &[Jet], machine: impl Fn(&[Jet]) -> Machine) -> Vec<f64> {
    let now = machine(motion);
    let along = |k: usize| {
        let shifted: Vec<Jet> = motion
            .iter()
            .enumerate()
            .map(|(i, s)| Jet {
                x: s.x,
                d: if i == k { 1.0 } else { 0.0 },
                dd: 0.0,
            })
            .collect();
        let shift = machine(&shifted);
        let mut work = 0.0;
        for (body, moved) in now.bodies.iter().zip(&shift.bodies) {
            let a = difference(body.centre.map(|x| x.dd), now.gravity);
            work += body.mass * dot(a, moved.centre.map(|x| x.d));
            work += body.inertia * body.angle.dd * moved.angle.d;
        }
        for push in &shift.pushes {
            work -= dot(push.force, push.at.map(|x| x.d));
        }
        for (length, tension) in &shift.springs {
            work += tension * length.d;
        }
        work
    };
    (0..motion.len()).map(along).collect()
}

/// Solves a small system of equations by elimination with exchange of rows.
pub(super) fn solved<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> [f64; N] {
    for k in 0..N {
        let largest = (k..N).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()));
        let largest = largest.expect("a row");
        a.swap(k, largest);
        b.swap(k, largest);
        for i in k + 1..N {
            let share = a[i][k] / a[k][k];
            for j in k..N {
                a[i][j] -= share * a[k][j];
            }
            b[i] -= share * b[k];
        }
    }
    for k in (0..N).rev() {
        let rest: f64 = (k + 1..N).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - rest) / a[k][k];
    }
    b
}
