//! The constraint matrix of a sketch in exact arithmetic. It is derived from the velocities of
//! coincident points and uses no body coordinates, no rotations, and no derivatives of Φ. Each row
//! may differ from the row of the `model` by a factor.

use model::BodyRef;

use super::{Link, Sketch, Tie, Vector};
use exact::Dyadic;

/// One row of C.
type Row = Vec<Dyadic>;

/// Rows of one joint or drive.
#[derive(Clone, Debug)]
pub struct ExactRows {
    /// Name of the joint or drive.
    pub name: String,
    /// Rows of C that belong to the joint or drive.
    pub rows: Vec<Row>,
}

impl Sketch {
    /// Returns the rows of every link, in the order of the links.
    #[must_use]
    pub fn exact_rows(&self) -> Vec<ExactRows> {
        let of = |link: &Link| ExactRows {
            name: link.name.clone(),
            rows: self.rows(link),
        };
        self.links.iter().map(of).collect()
    }

    fn rows(&self, link: &Link) -> Vec<Row> {
        let body = |slot: usize| link.bodies[slot];
        // Along u, the velocities of the point `at` on both bodies are equal.
        let together = |at: Vector, u: Vector| {
            let mut row = self.zero();
            self.add_velocity(&mut row, body(1), at, u, 1.0);
            self.add_velocity(&mut row, body(0), at, u, -1.0);
            row
        };
        let spin = |factors: &[(usize, f64)]| {
            let mut row = self.zero();
            for &(slot, factor) in factors {
                self.add_spin(&mut row, body(slot), factor);
            }
            row
        };
        let across = |u: Vector| [-u[1], u[0]];
        let (x, y, equal) = ([1.0, 0.0], [0.0, 1.0], [(0, -1.0), (1, 1.0)]);
        match link.tie {
            Tie::Revolute { at } => vec![together(at, x), together(at, y)],
            Tie::Translational { at, axis, .. } => vec![together(at, across(axis)), spin(&equal)],
            Tie::Fixed { at } => vec![together(at, x), together(at, y), spin(&equal)],
            Tie::PinInSlot { at, axis, .. } => vec![together(at, across(axis))],
            Tie::Distance { from, at } => {
                let d = [0, 1].map(|k| Dyadic::from(at[k]).minus(&Dyadic::from(from[k])));
                let mut row = together(at, x);
                for (a, b) in row.iter_mut().zip(together(at, y)) {
                    *a = a.times(&d[0]).plus(&b.times(&d[1]));
                }
                vec![row]
            }
            Tie::Angle | Tie::AngleDrive => vec![spin(&equal)],
            Tie::Gear { ratio } => {
                let mut row = spin(&[(0, -ratio), (1, 1.0), (2, -1.0)]);
                self.add_spin(&mut row, body(2), ratio);
                vec![row]
            }
            Tie::RackAndPinion { at, axis, radius } => {
                let mut row = together(at, axis);
                self.add_spin(&mut row, body(1), radius);
                self.add_spin(&mut row, body(0), -radius);
                vec![row]
            }
            Tie::KnifeEdge { at, normal } => {
                let mut row = self.zero();
                self.add_velocity(&mut row, body(0), at, normal, 1.0);
                vec![row]
            }
            Tie::Rolling {
                at,
                direction,
                radius,
            } => {
                let mut row = spin(&[(1, -radius)]);
                self.add_velocity(&mut row, body(0), at, direction, 1.0);
                vec![row]
            }
            Tie::DisplacementDrive { at, axis, .. } => vec![together(at, axis)],
        }
    }

    fn zero(&self) -> Row {
        vec![Dyadic::from(0.0); 3 * self.bodies.len()]
    }

    /// Adds `factor·uᵀ·v` with the velocity `v = ṙ + ω·(at − r)⊥` of the point `at` on a body.
    fn add_velocity(&self, row: &mut Row, body: BodyRef, at: Vector, u: Vector, factor: f64) {
        let BodyRef::Body(k) = body else { return };
        let factor = Dyadic::from(factor);
        let u = u.map(|u| Dyadic::from(u).times(&factor));
        let r = self.bodies[k].position;
        let arm = [0, 1].map(|axis| Dyadic::from(at[axis]).minus(&Dyadic::from(r[axis])));
        let turned = u[1].times(&arm[0]).minus(&u[0].times(&arm[1]));
        for (entry, value) in row[3 * k..].iter_mut().zip([&u[0], &u[1], &turned]) {
            *entry = entry.plus(value);
        }
    }

    /// Adds `factor·ω` with the angular velocity of a body.
    fn add_spin(&self, row: &mut Row, body: BodyRef, factor: f64) {
        if let BodyRef::Body(k) = body {
            row[3 * k + 2] = row[3 * k + 2].plus(&Dyadic::from(factor));
        }
    }
}
