//! The values stored by constraints (points, directions and scalars), and the derivatives of rows
//! with respect to them.
//!
//! The crate `solvability` computes how the configuration changes if the data change, and the
//! effect of a change of the data on a rank.

mod displaced;
mod gradients;
mod slopes;

use std::ops::Range;

use joints::spec::DatumShape;

use crate::element::PlacedConstraint;
use crate::mechanism::Mechanism;
use crate::rounding::ROUNDING;
use crate::size::size_of;
use crate::space::norm;
use crate::system::Scratch;
use crate::tolerance::Tolerance;

pub use gradients::DataGradients;
pub use slopes::DataSlopes;

/// A point, a direction or a scalar of a constraint. The components of a block change together.
#[derive(Clone, Debug, PartialEq)]
pub struct DataBlock {
    /// Index of the joint or drive in the groups of the layout.
    pub group: usize,
    /// Name of the parameter, or of the stored initial value.
    pub name: &'static str,
    /// Indices of the components of the block among all stored values of the mechanism. A point or
    /// a direction has as many components as the space has dimensions, a set of axes has three, and
    /// other data have one component.
    pub numbers: Range<usize>,
    /// Unit of changes of this block.
    pub unit: DataUnit,
    /// Restriction of the changes, if the block is a direction of constant length.
    across: Option<Across>,
    /// The largest value that is added to the block (in its unit); the rounding error of the block
    /// is proportional to this value.
    pub scale: f64,
    /// The tolerance of the block (in its unit), as stated by the joint, the body or the scene.
    pub tolerance: Option<f64>,
}

/// The changes of a direction that do not change its length.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Across {
    /// Changes in the plane, along this unit vector.
    Along([f64; 2]),
    /// Changes in space, perpendicular to this unit vector.
    Normal([f64; 3]),
}

impl Across {
    fn of(direction: &[f64]) -> Option<Self> {
        match *direction {
            [x, y] => Some(Self::Along([-y, x])),
            [x, y, z] => Some(Self::Normal([x, y, z])),
            _ => None,
        }
    }
}

/// Unit of a change of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum DataUnit {
    /// Metre.
    Length,
    /// Radian; also used for ratios of angles.
    Angle,
}

impl DataBlock {
    /// Returns the components of a gradient that belong to this block. The gradient contains the
    /// derivatives with respect to all stored values. Unused components are zero.
    #[must_use]
    pub fn part(&self, gradient: &[f64]) -> [f64; 3] {
        let own = &gradient[self.numbers.clone()];
        match (self.across, own) {
            (Some(Across::Along([x, y])), &[a, b]) => [a * x + b * y, 0.0, 0.0],
            (Some(Across::Normal(n)), &[a, b, c]) => {
                let along = a * n[0] + b * n[1] + c * n[2];
                [a - along * n[0], b - along * n[1], c - along * n[2]]
            }
            (_, &[a]) => [a, 0.0, 0.0],
            (_, &[a, b]) => [a, b, 0.0],
            (_, &[a, b, c]) => [a, b, c],
            _ => [0.0; 3],
        }
    }

    /// Returns the largest change of a quantity with this gradient if the block changes by `moved`.
    #[must_use]
    pub fn change(&self, gradient: &[f64], moved: f64) -> f64 {
        let [x, y, z] = self.part(gradient);
        x.hypot(y).hypot(z) * moved
    }

    /// Returns the uncertainty of the block: the stated tolerance, or otherwise the rounding error.
    #[must_use]
    pub fn known_to(&self) -> f64 {
        self.tolerance.unwrap_or(ROUNDING * self.scale)
    }
}

/// Returns the part of a quantity that can result from changes of the data within their stated
/// tolerances. This part is [`SHARED`] times the sum of the largest changes. `gradient` contains
/// the derivatives of the quantity with respect to all stored values.
#[must_use]
pub fn explained(blocks: &[DataBlock], gradient: &[f64]) -> f64 {
    let change = |b: &DataBlock| b.change(gradient, b.tolerance.unwrap_or(0.0));
    SHARED * blocks.iter().map(change).sum::<f64>()
}

/// A contradiction within the stated tolerances is distributed among several rows. Therefore the
/// residual of a row may be up to this multiple of the effect of the data of the row.
pub const SHARED: f64 = 3.0;

/// The values that the constraints of a mechanism store.
#[derive(Clone, Copy)]
pub struct Data<'m>(&'m Mechanism);

/// Derivatives of forces `Cᵀ·λ` with respect to the pose: `∂(Cᵀ·λ)_i/∂x_j`, n_v×n_v, as triplets.
#[derive(Clone, Debug)]
pub struct ForceDerivatives(Vec<(usize, usize, f64)>);

impl ForceDerivatives {
    /// Adds the gradient of `λᵀ·C·v` with respect to the pose to `out`. Both `v` and `out` have n_v
    /// values.
    ///
    /// # Panics
    /// Panics if a slice is too short.
    pub fn add_power(&self, v: &[f64], out: &mut [f64]) {
        for &(i, j, d) in &self.0 {
            out[j] += d * v[i];
        }
    }
}

impl Mechanism {
    /// Returns the values that the constraints of the mechanism store.
    #[must_use]
    pub fn data(&self) -> Data<'_> {
        Data(self)
    }
}

impl<'m> Data<'m> {
    /// Returns the constraints, each with the indices of its values among all stored values.
    fn numbered(self) -> impl Iterator<Item = (&'m PlacedConstraint, Range<usize>)> {
        let mut first = 0;
        self.0.elements.constraints.iter().map(move |c| {
            let numbers = first..first + c.spec().n_data();
            first = numbers.end;
            (c, numbers)
        })
    }

    /// Returns whether a tolerance is stated for any of these values.
    pub(crate) fn has_tolerances(self) -> bool {
        self.0.has_tolerances()
    }

    /// Returns the number of values stored by all constraints.
    #[must_use]
    pub fn count(self) -> usize {
        self.numbered().last().map_or(0, |(_, numbers)| numbers.end)
    }

    /// Returns all points, directions and scalars of the constraints, at the configuration in the
    /// work space. The function allocates memory.
    #[must_use]
    pub fn blocks(self, s: &Scratch) -> Vec<DataBlock> {
        let mut blocks = Vec::new();
        let mut numbers = Vec::new();
        let stated = self.0.has_tolerances().then(|| size_of(self.0, s));
        for (group, (c, places)) in self.numbered().enumerate() {
            numbers.clear();
            numbers.resize(places.len(), 0.0);
            c.kernels().data(&mut numbers);
            let length = self.length_scale(c, s, &numbers);
            let turned = c.site.moving().map(|body| s.bodies.angle(body).abs());
            let angle = turned.fold(1.0, f64::max);
            for datum in c.spec().data {
                let at = places.start + datum.first;
                let block = |offset: usize, count: usize, unit: DataUnit, is_direction: bool| {
                    let own = &numbers[datum.first + offset..datum.first + offset + count];
                    let largest = own.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                    DataBlock {
                        group,
                        name: datum.name,
                        numbers: at + offset..at + offset + count,
                        unit,
                        across: is_direction.then(|| Across::of(own)).flatten(),
                        scale: match (unit, is_direction) {
                            (DataUnit::Length, _) => length,
                            (_, true) => 1.0,
                            (_, false) => largest.max(angle),
                        },
                        tolerance: stated.and_then(|size| {
                            tolerance_of(self.0, c, (datum.shape, own), unit, size)
                        }),
                    }
                };
                match datum.shape {
                    DatumShape::Point { .. } | DatumShape::KeptVector { .. } => {
                        blocks.push(block(0, datum.count, DataUnit::Length, false));
                    }
                    DatumShape::Direction { .. } => {
                        blocks.push(block(0, datum.count, DataUnit::Angle, true));
                    }
                    DatumShape::Axes { .. } => {
                        blocks.push(block(0, datum.count, DataUnit::Angle, false));
                    }
                    DatumShape::Plane => {
                        blocks.push(block(0, 3, DataUnit::Length, false));
                        blocks.push(block(3, 3, DataUnit::Angle, true));
                    }
                    DatumShape::Line => {
                        blocks.push(block(0, 2, DataUnit::Length, false));
                        blocks.push(block(2, 2, DataUnit::Angle, true));
                    }
                    DatumShape::Number(unit) | DatumShape::Kept(unit) if unit.is_length() => {
                        blocks.push(block(0, 1, DataUnit::Length, false));
                    }
                    DatumShape::Number(_) | DatumShape::Kept(_) => {
                        blocks.push(block(0, 1, DataUnit::Angle, false));
                    }
                }
            }
        }
        blocks
    }

    /// Returns the largest change of `λᵀ·Φ` if each block changes by the value that `moved`
    /// returns. `lambda` must have at least m values.
    #[must_use]
    pub fn phi_change(
        self,
        s: &Scratch,
        lambda: &[f64],
        blocks: &[DataBlock],
        moved: impl Fn(&DataBlock) -> f64,
    ) -> f64 {
        let mut gradient = vec![0.0; self.count()];
        self.slopes(s).add_phi(lambda, 1.0, &mut gradient);
        let changes = blocks.iter().map(|b| b.change(&gradient, moved(b)));
        changes.sum()
    }

    /// Adds the gradient of `λᵀ·C·v` with respect to the pose to `out`. The gradient has n_v
    /// values, one for each velocity component.
    pub fn add_power_by_pose(self, s: &Scratch, lambda: &[f64], v: &[f64], out: &mut [f64]) {
        self.each_force_derivative(s, lambda, |i, j, d| out[j] += d * v[i]);
    }

    /// Returns the derivatives of the forces `Cᵀ·λ` with respect to the pose. With these
    /// derivatives, `λᵀ·C·v` can be differentiated for many velocities.
    #[must_use]
    pub fn force_derivatives(self, s: &Scratch, lambda: &[f64]) -> ForceDerivatives {
        let mut all = Vec::new();
        self.each_force_derivative(s, lambda, |i, j, d| {
            if d != 0.0 {
                all.push((i, j, d));
            }
        });
        ForceDerivatives(all)
    }

    /// Calls `take` for each derivative of `(Cᵀ·λ)_i` with respect to the pose coordinate of
    /// velocity component j.
    fn each_force_derivative(
        self,
        s: &Scratch,
        lambda: &[f64],
        mut take: impl FnMut(usize, usize, f64),
    ) {
        let (mut own, mut storage) = (Vec::new(), Vec::new());
        for c in &self.0.elements.constraints {
            let pattern = c.spec().d_force_dx;
            let lambda = c.rows.of(lambda, &mut storage);
            if pattern.is_empty() || lambda.iter().all(|l| *l == 0.0) {
                continue;
            }
            own.clear();
            own.resize(pattern.len(), 0.0);
            c.d_force_dx(&s.slots, lambda, &mut own);
            for (&[force, turned], d) in pattern.iter().zip(&own) {
                if let (Some(i), Some(j)) = (c.site.column(force), c.site.column(turned)) {
                    take(i, j, *d);
                }
            }
        }
    }

    /// Returns the largest length (m) that occurs in the computation of the points of a constraint.
    /// The lengths are the distances of the points from the origins of their frames, the lever arms
    /// of the bodies, and the distances of the bodies from the global origin.
    fn length_scale(self, c: &PlacedConstraint, s: &Scratch, numbers: &[f64]) -> f64 {
        let points = c.spec().data.iter().filter_map(|datum| {
            let at = &numbers[datum.numbers()];
            match datum.shape {
                DatumShape::Point { .. } | DatumShape::KeptVector { .. } if at.len() == 3 => {
                    Some(at[0].hypot(at[1]).hypot(at[2]))
                }
                DatumShape::Plane => Some(at[0].hypot(at[1]).hypot(at[2])),
                DatumShape::Point { .. } | DatumShape::KeptVector { .. } | DatumShape::Line => {
                    Some(at[0].hypot(at[1]))
                }
                DatumShape::Number(unit) | DatumShape::Kept(unit) if unit.is_length() => {
                    Some(at[0].abs())
                }
                _ => None,
            }
        });
        let bodies = c.site.moving();
        let bodies = bodies.map(|body| self.0.reach(body).max(norm(&s.bodies.origin(body))));
        points.chain(bodies).fold(0.0, f64::max)
    }
}

/// Returns the uncertainty of data of this shape in a constraint, in the unit of the data; `size`
/// is the size of the mechanism (m). The length tolerance is the tolerance of the constraint. If it
/// is not stated, the function uses the tolerance of a marker at the point, of the body in whose
/// frame the data are, or of the scene, in this order. The angle tolerance is the tolerance of the
/// scene, or the length tolerance divided by the size if the scene does not state an angle
/// tolerance.
fn tolerance_of(
    mechanism: &Mechanism,
    c: &PlacedConstraint,
    (shape, numbers): (DatumShape, &[f64]),
    unit: DataUnit,
    size: f64,
) -> Option<f64> {
    let slot = match shape {
        DatumShape::Point { slot }
        | DatumShape::Direction { slot }
        | DatumShape::Axes { slot }
        | DatumShape::KeptVector { slot } => Some(slot),
        DatumShape::Line | DatumShape::Plane | DatumShape::Number(_) | DatumShape::Kept(_) => None,
    };
    let body = slot.and_then(|slot| c.site.bodies.get(slot).copied());
    let bodies = mechanism.bodies();
    let of_marker = || match shape {
        DatumShape::Point { .. } => mechanism.observed.tolerance_at(bodies, body?, numbers),
        _ => None,
    };
    let of_body = || bodies[body?.moving()?].tolerance;
    let nearest = c.tolerance.or_else(of_marker).or_else(of_body);
    let of_scene = mechanism.tolerance();
    let stated = Tolerance {
        length: nearest.or(of_scene.length),
        ..of_scene
    };
    match unit {
        DataUnit::Length => stated.length,
        DataUnit::Angle => stated.angle_at(size),
    }
}
