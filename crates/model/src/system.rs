//! The interface of a mechanism for solvers: sizes, patterns and kernels. The kernels write to
//! storage of the caller and do not allocate memory. Each kernel computes one result, so that no
//! unused result is computed.

use std::ops::Range;

use linalg::{AddedMass, MassMatrix, Matrix, Scaling};

use crate::element::{Bodies, Slots};
use crate::group::{ColumnKind, ConstraintGroup, ConstraintId};
use crate::space::SpaceKind;

/// The equations of a mechanism.
///
/// At one instant, the caller first calls [`System::pose`], then any of [`System::phi`],
/// [`System::c`], [`System::b`]. The caller then calls [`System::twist`], and finally
/// [`System::gamma`] and [`System::force`]. The [`Scratch`] contains the results.
pub trait System: Sync {
    /// Sizes, patterns and labels.
    fn layout(&self) -> &Layout;

    /// Returns the masses and moments of inertia of the bodies, n_v values. They are the diagonal
    /// of M, without the armatures of joints. Use them as a metric. The equations of motion use
    /// [`System::inertia`]. The entry of a rotation without inertia that influences nothing is any
    /// positive number, so that the rotation has no angular acceleration.
    fn mass(&self) -> &[f64];

    /// Returns M at the configuration of the last [`System::c`] or [`System::force`]. M is
    /// diagonal, except for armatures of joints: `M = diag(mass) + Σ a·gᵀ·g` with ṡ = g·v for the
    /// joint coordinate s of the armature a.
    fn inertia<'s>(&'s self, s: &'s Scratch) -> MassMatrix<'s>;

    /// Creates storage for one evaluation at a time.
    fn scratch(&self) -> Scratch;

    /// Sets time and coordinates. The function evaluates the poses of bodies and the values of
    /// functions of time.
    fn pose(&self, t: f64, q: &[f64], s: &mut Scratch);

    /// Computes `s.phi`: Φ(q, t), m values.
    fn phi(&self, s: &mut Scratch);

    /// Computes `s.entries`: the entries of C. Also computes the rows of M.
    fn c(&self, s: &mut Scratch);

    /// Computes `s.b`: b of C·v = b, m + h values.
    fn b(&self, s: &mut Scratch);

    /// Sets velocities.
    fn twist(&self, v: &[f64], s: &mut Scratch);

    /// Computes `s.gamma`: Γ of C·v̇ = Γ, m + h values.
    fn gamma(&self, s: &mut Scratch);

    /// Computes `s.force`: Q, n_v values. Q contains the terms of the inertia that are quadratic in
    /// v: `−ω × J·ω` of bodies in space, and `gᵀ·a·γ` of armatures with s̈ = g·v̇ − γ. Also
    /// computes the rows of M.
    fn force(&self, s: &mut Scratch);

    /// Computes q̇ = T(q)·v. The rates of states of force laws are zero here: they do not depend on
    /// velocities alone; see [`Mechanism::state_rates`](crate::Mechanism::state_rates).
    fn rate(&self, q: &[f64], v: &[f64], qd: &mut [f64]);

    /// Moves the configuration q (n_q) by d (n_v): translations (m) and rotations (rad).
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism, System};
    /// let mut d = Description::new("stone");
    /// d.body(Body::new("stone", 1.0, 1.0));
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let mut q = [1.0, 2.0, 0.5];
    /// mechanism.displace(&mut q, &[0.5, 0.0, 1.0]);
    /// assert_eq!(q, [1.5, 2.0, 1.5]);
    /// let mut moved = [0.0; 3];
    /// mechanism.difference(&q, &[1.0, 2.0, 0.5], &mut moved);
    /// assert_eq!(moved, [0.5, 0.0, 1.0]);
    /// ```
    fn displace(&self, q: &mut [f64], d: &[f64]);

    /// Computes the displacement (n_v) that moves the configuration `from` to q. The displacement
    /// also determines the change of the unwrapped angles.
    fn difference(&self, q: &[f64], from: &[f64], d: &mut [f64]);
}

/// Sizes, patterns and labels of a mechanism.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The space of the bodies, which defines the meaning of the columns of C and of the components
    /// of reactions.
    pub space: SpaceKind,
    /// Number of coordinates. The coordinates of the bodies come first, followed by the unwrapped
    /// angles and the states of force laws.
    pub n_q: usize,
    /// Number of unwrapped angles among the coordinates. Unwrapped angles are angles in space since
    /// the start, including full revolutions. Unwrapped angles exist for elements that need them.
    pub turns: usize,
    /// Number of states of force laws among the coordinates. Their rates follow from the laws.
    pub states: usize,
    /// Number of velocities.
    pub n_v: usize,
    /// Number of holonomic rows m, which come first.
    pub m: usize,
    /// Number of nonholonomic rows h.
    pub h: usize,
    /// Pattern of C.
    pub pattern: Pattern,
    /// Joints with holonomic rows, drives, and joints without holonomic rows, each in the order of
    /// the description. Holonomic rows follow this order; nonholonomic rows follow the order of the
    /// description.
    pub groups: Vec<ConstraintGroup>,
    /// The joint or drive of each row.
    pub owners: Vec<ConstraintId>,
    /// One label for each row.
    pub labels: Vec<RowLabel>,
    /// Times at which a derivative of a function of time jumps, ascending.
    pub break_times: Vec<f64>,
    /// Whether a row depends on time explicitly.
    pub rheonomic: bool,
    /// Time of the start (s).
    pub start_time: f64,
}

impl Layout {
    /// Returns the number of rows m + h.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.m + self.h
    }

    /// Returns whether a joint is one-sided or can slip.
    #[must_use]
    pub fn has_contact_limits(&self) -> bool {
        !self.groups.iter().all(|group| group.limits.is_none())
    }

    /// Returns the number of coordinates of the bodies.
    #[must_use]
    pub fn n_of_bodies(&self) -> usize {
        self.angles().start
    }

    /// Returns the range of the unwrapped angles in the coordinates.
    pub(crate) fn angles(&self) -> std::ops::Range<usize> {
        let end = self.n_q - self.states;
        end - self.turns..end
    }

    /// Returns the last number before a time t (s) if t is a break time after the start; otherwise
    /// returns t. A row at a break time has the values just before the break time.
    #[must_use]
    pub fn before_break(&self, t: f64) -> f64 {
        let found = self.break_times.binary_search_by(|at| at.total_cmp(&t));
        if found.is_ok() && t > self.start_time {
            t.next_down()
        } else {
            t
        }
    }

    /// Returns the rows of drives, ascending.
    #[must_use]
    pub fn drive_rows(&self) -> Vec<usize> {
        let drives = self.groups.iter().filter(|g| g.is_drive());
        drives.flat_map(|g| g.rows.iter()).collect()
    }

    /// Returns the joint or drive of row `i`.
    ///
    /// # Panics
    /// Panics if the row does not exist.
    #[must_use]
    pub fn owner(&self, i: usize) -> &ConstraintGroup {
        &self.groups[self.owners[i].0]
    }

    /// Returns row `i` of C as (column, value).
    pub fn row<'a>(&'a self, s: &'a Scratch, i: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let (column, entry) = (&self.pattern.column, &self.pattern.entry);
        let columns = column[self.pattern.row(i)].iter();
        let places = columns.zip(&entry[self.pattern.row(i)]);
        places.map(|(&column, &entry)| (column, s.entries[entry]))
    }

    /// Returns the ids of all joints and drives, in the order of [`Layout::groups`].
    pub fn constraint_ids(&self) -> impl Iterator<Item = ConstraintId> + use<> {
        (0..self.groups.len()).map(ConstraintId)
    }

    /// Returns the columns of C of a body.
    #[must_use]
    pub fn columns(&self, body: usize) -> Range<usize> {
        self.space.columns_of(body)
    }

    /// Returns the kind of velocity of each column of C, n_v entries.
    #[must_use]
    pub fn column_kinds(&self) -> Vec<ColumnKind> {
        let kind = |j| {
            if self.space.is_rotation(j) {
                ColumnKind::Rotation
            } else {
                ColumnKind::Translation
            }
        };
        (0..self.n_v).map(kind).collect()
    }

    /// Returns whether row `i` compares angles. Such a row contains no translation.
    #[must_use]
    pub fn is_angular(&self, i: usize) -> bool {
        let columns = &self.pattern.column[self.pattern.row(i)];
        columns.iter().all(|j| self.space.is_rotation(*j))
    }

    /// Returns the SI unit of a component of a reaction. The component belongs to a force or a
    /// torque, or is the named component. The named component is a torque if all rows are angular.
    #[must_use]
    pub fn load_unit(&self, id: ConstraintId, component: &str) -> &'static str {
        let own = &self.groups[id.0].rows;
        self.space.load_unit(component).unwrap_or_else(|| {
            let is_torque = own.iter().all(|row| self.is_angular(row));
            if is_torque { "N·m" } else { "N" }
        })
    }

    /// Returns the scaling that makes C dimensionless for a mechanism of this size. Columns of
    /// rotations are divided by the size, rounded to a power of two. The scaled C has the same
    /// ranks, dependencies and verdicts as C. Margins of the scaled C do not depend on units.
    #[must_use]
    pub fn dimension_scaling(&self, size: f64) -> Scaling {
        let exponent = size.log2().round();
        let mut scaling = Scaling::identity(self.rows(), self.n_v);
        if exponent.is_finite() {
            for body in scaling.cols.chunks_exact_mut(self.space.n_v()) {
                body[self.space.torques()].fill(-(exponent as i32));
            }
        }
        scaling
    }

    /// Writes row `i` of C into a dense row of n_v values.
    pub fn scatter_row(&self, s: &Scratch, i: usize, out: &mut [f64]) {
        out.fill(0.0);
        for (column, value) in self.row(s, i) {
            out[column] += value;
        }
    }

    /// Returns C as a dense matrix. The function allocates memory.
    #[must_use]
    pub fn dense(&self, s: &Scratch) -> Matrix {
        let mut c = Matrix::zeros(self.rows(), self.n_v);
        for i in 0..self.rows() {
            self.scatter_row(s, i, c.row_mut(i));
        }
        c
    }

    /// Returns the residual `C·v − b` of row `i`.
    #[must_use]
    pub fn velocity_residual(&self, s: &Scratch, i: usize, v: &[f64]) -> f64 {
        self.row(s, i).map(|(column, c)| c * v[column]).sum::<f64>() - s.b[i]
    }
}

/// Pattern of C by rows. The entries of row i have the indices `start[i]..start[i + 1]`.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    /// Index of the first entry of each row. The length of the list is the number of rows plus one.
    pub start: Vec<usize>,
    /// Column of each entry.
    pub column: Vec<usize>,
    /// Index of each entry in [`Scratch::entries`].
    pub entry: Vec<usize>,
}

impl Pattern {
    /// Returns the indices of the entries of row `i`.
    pub(crate) fn row(&self, i: usize) -> Range<usize> {
        self.start[i]..self.start[i + 1]
    }
}

/// Name of a row: the joint, and the row within the joint.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RowLabel {
    /// Number of the row, from 1.
    pub number: usize,
    /// Name of the joint or drive.
    pub joint: String,
    /// Name of the row within the joint.
    pub row: &'static str,
}

impl std::fmt::Display for RowLabel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} (`{}`, {})", self.number, self.joint, self.row)
    }
}

/// Storage of one evaluation, created by [`System::scratch`]. The storage contains the results of
/// the kernels. The storage is valid only for the mechanism that created it. An evaluation reuses
/// some results of the previous evaluation, such as constant entries of C. For another mechanism,
/// these results would be wrong.
#[derive(Clone, Debug)]
pub struct Scratch {
    /// Time of the poses.
    pub t: f64,
    /// Poses of the bodies.
    pub bodies: Bodies,
    /// Φ, m values.
    pub phi: Vec<f64>,
    /// Entries of the blocks of C, constraint by constraint, including columns of the ground.
    pub entries: Vec<f64>,
    /// b, m + h values.
    pub b: Vec<f64>,
    /// Γ, m + h values.
    pub gamma: Vec<f64>,
    /// Q, n_v values.
    pub force: Vec<f64>,
    /// Arguments of the kernels of all elements.
    pub(crate) slots: Slots,
    /// Angular velocities of the bodies in their axes, in space only.
    pub(crate) spins: Vec<[f64; 3]>,
    /// Time at which the functions of time were evaluated; initially NaN.
    pub(crate) jets_at: f64,
    pub(crate) buffers: KernelBuffers,
    pub(crate) armatures: ArmatureRows,
}

/// Storage for results of kernels.
#[derive(Clone, Debug)]
pub(crate) struct KernelBuffers {
    /// Results of one kernel.
    pub(crate) block: Vec<f64>,
    /// Values of the rows of one constraint.
    pub(crate) own_rows: Vec<f64>,
}

/// Results of the kernels of armatures.
#[derive(Clone, Debug)]
pub(crate) struct ArmatureRows {
    /// The rows g of M, one for each armature.
    pub(crate) added: AddedMass,
    /// γ of each armature, with s̈ = g·v̇ − γ.
    pub(crate) gamma: Vec<f64>,
}
