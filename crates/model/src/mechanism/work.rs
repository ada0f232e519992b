//! Counts the operations of the kernels of a mechanism in each evaluation. The module also counts
//! the operations that the structure of the mechanism makes unnecessary. The kernels skip
//! operations by the same criteria.

use super::{Elements, Mechanism};
use crate::element::PlacedConstraint;
use crate::system::Layout;

/// Number of operations in each evaluation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Bodies whose angle the constraints keep at its initial value, in ascending order. The sine
    /// and cosine of these angles do not change.
    pub without_turning: Vec<usize>,
    /// Number of entries of C, without the columns of the ground.
    pub entries: usize,
    /// Number of entries that depend on the configuration.
    pub varying_entries: usize,
    /// Number of rows whose b and Φt may differ from zero.
    pub rows_of_time: usize,
    /// Number of rows whose Γ may differ from zero.
    pub rows_of_gamma: usize,
    /// Number of functions of time.
    pub functions: usize,
    /// Number of applied forces, without gravity.
    pub forces: usize,
}

impl Work {
    /// Counts the operations of the kernels of a mechanism in each evaluation. The function
    /// allocates memory.
    ///
    /// ```
    /// use joints::{Direction, Translational};
    /// use pfaff_model::{Body, BodyRef, Description, Joint, Mechanism, Work};
    /// // A slider on the ground along x does not rotate, because of its row `angle`.
    /// let guide = Translational::new([0.0; 2], [0.0; 2], Direction::X);
    /// let d = Description {
    ///     bodies: vec![Body { name: "slider".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("guide", &[BodyRef::Ground, BodyRef::Body(0)], guide)],
    ///     ..Description::default()
    /// };
    /// let work = Work::of(&Mechanism::build(&d).unwrap());
    /// assert_eq!((work.without_turning, work.rows_of_time, work.forces), (vec![0], 0, 0));
    /// ```
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Self {
        let (held, elements) = (&mechanism.held, &mechanism.elements);
        let mut work = Self {
            without_turning: (0..held.len()).filter(|&k| held[k]).collect(),
            functions: elements.functions().count(),
            forces: elements.forces.len(),
            ..Self::default()
        };
        for c in &elements.constraints {
            let n = c.rows.len();
            work.rows_of_time += if c.depends_on_time() { n } else { 0 };
            work.rows_of_gamma += if c.has_gamma() { n } else { 0 };
        }
        let constraints = elements.constraints.iter();
        let varying: Vec<usize> = constraints
            .flat_map(|c| c.varying.iter().map(|k| c.entries.start + k))
            .collect();
        let entries = &mechanism.layout.pattern.entry;
        work.entries = entries.len();
        let varies = |entry: &&usize| varying.binary_search(entry).is_ok();
        work.varying_entries = entries.iter().filter(varies).count();
        work
    }
}

/// Returns for each body whether its angle keeps its initial value. The angle of a body keeps its
/// initial value if a holonomic row that does not depend on time connects the body with the ground,
/// or with bodies whose angles keep their initial values. Only rows that contain no translations
/// and have constant entries are examined. Therefore some bodies with this property may not be
/// found.
pub(super) fn held_bodies(elements: &Elements, layout: &Layout, bodies: usize) -> Vec<bool> {
    let constraints = elements.constraints.iter();
    let rows: Vec<Vec<usize>> = constraints
        .filter(|c| !c.depends_on_time())
        .flat_map(|c| c.rows.holonomic.clone().map(move |i| (c, i)))
        .filter(|&(_, i)| layout.is_angular(i))
        .filter_map(|(c, i)| constant_row(elements, layout, c, i))
        .collect();
    let mut of_body = vec![Vec::new(); bodies];
    for (k, row) in rows.iter().enumerate() {
        row.iter().for_each(|&body| of_body[body].push(k));
    }
    let mut held = vec![false; bodies];
    let mut free: Vec<usize> = rows.iter().map(Vec::len).collect();
    // Rows in which all angles except one are fixed. These rows fix the remaining angle.
    let mut holding: Vec<usize> = (0..rows.len()).filter(|&k| free[k] == 1).collect();
    while let Some(k) = holding.pop() {
        let Some(&body) = rows[k].iter().find(|&&body| !held[body]) else {
            continue;
        };
        held[body] = true;
        for &row in &of_body[body] {
            free[row] -= 1;
            if free[row] == 1 {
                holding.push(row);
            }
        }
    }
    held
}

/// Returns the bodies in a row of a constraint with constant entries. Bodies whose entry is zero
/// are omitted.
fn constant_row(
    elements: &Elements,
    layout: &Layout,
    c: &PlacedConstraint,
    i: usize,
) -> Option<Vec<usize>> {
    let pattern = &layout.pattern;
    let mut bodies = Vec::new();
    for k in pattern.row(i) {
        let entry = pattern.entry[k];
        if c.varying.contains(&(entry - c.entries.start)) {
            return None;
        }
        if elements.entries[entry] != 0.0 {
            bodies.push(layout.space.body_of(pattern.column[k]));
        }
    }
    Some(bodies)
}
