//! Specifications of couplings. The specification of a definition is a constant. However, the
//! specification of a coupling depends on its two joint coordinates. The specification is created
//! once for each pair of coordinates and stored.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use joints::spec::{
    ConstraintSpec, Datum, DatumShape, Entry, Parameter, Role, Row, Shape, Spec, Unit,
};

/// Type of couplings in scene files.
pub(crate) const TYPE: &str = "coupling";

/// The specification of a coupling, with the patterns of the matrices that its kernels compute.
pub(super) struct CouplingFacts {
    pub(super) spec: ConstraintSpec,
    /// Number of velocities of a body.
    n_dof: usize,
    /// The index of the row entry for each column, if the column has an entry.
    entry_of: Vec<Option<usize>>,
}

impl CouplingFacts {
    /// Returns the index of the row entry for a velocity component `dof` of the body `slot`. The
    /// index exists for the entries of the joint coordinates.
    pub(super) fn entry(&self, slot: usize, dof: usize) -> usize {
        self.entry_of[self.column(slot, dof)].unwrap_or_default()
    }

    pub(super) fn column(&self, slot: usize, dof: usize) -> usize {
        self.n_dof * slot + dof
    }

    /// Converts a column in the block of one joint coordinate to the column in the block of the
    /// coupling.
    pub(super) fn of_side(&self, slots: [usize; 2], column: usize) -> usize {
        self.column(slots[column / self.n_dof], column % self.n_dof)
    }
}

/// Names of the bodies of a coupling.
const SLOTS: [&str; 4] = ["i", "j", "k", "l"];

/// All specifications created so far: at most one for each pair of joint coordinates, each choice
/// of common bodies, and each degree.
static KEPT: Mutex<Option<HashMap<Key, &'static CouplingFacts>>> = Mutex::new(None);

/// The addresses of the specifications of both joint coordinates, the indices of their bodies, and
/// the degree.
type Key = ([usize; 2], [[usize; 2]; 2], usize);

/// Returns the specification of the coupling of two joint coordinates by a polynomial of this
/// degree. The other arguments are the indices of the bodies of each coordinate, the total number
/// of bodies, and the number of velocity components of a body.
pub(super) fn facts(
    measures: [&'static ConstraintSpec; 2],
    slots: [[usize; 2]; 2],
    [n_slots, n_dof]: [usize; 2],
    degree: usize,
) -> &'static CouplingFacts {
    // Specifications are constants, so an address identifies the content. Names are not sufficient,
    // because definitions of the plane, of space and of other crates may have equal names.
    let place = |spec: &'static ConstraintSpec| std::ptr::from_ref(spec).addr();
    let key = (measures.map(place), slots, degree);
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = kept.get_or_insert_default();
    kept.entry(key)
        .or_insert_with(|| Box::leak(Box::new(made(measures, slots, [n_slots, n_dof], degree))))
}

fn made(
    measures: [&'static ConstraintSpec; 2],
    slots: [[usize; 2]; 2],
    [n_slots, n_dof]: [usize; 2],
    degree: usize,
) -> CouplingFacts {
    let columns = n_dof * n_slots;
    let mut facts = CouplingFacts {
        spec: ConstraintSpec {
            common: common(measures, slots, n_slots),
            ..PLAIN
        },
        n_dof,
        entry_of: vec![None; columns],
    };
    let mut row: Vec<usize> = Vec::new();
    for (measure, slots) in measures.iter().zip(slots) {
        row.extend(measure.c.iter().map(|e| facts.column(slots[e.slot], e.dof)));
    }
    row.sort_unstable();
    row.dedup();
    for (entry, &column) in row.iter().enumerate() {
        facts.entry_of[column] = Some(entry);
    }
    let c = row.iter().map(|k| Entry::varying(0, k / n_dof, k % n_dof));
    // The second derivative of the polynomial multiplies the outer product of the gradient of x
    // with itself.
    let own = &measures[0].c;
    let of_x = |e: &Entry| facts.column(slots[0][e.slot], e.dof);
    let outer = own
        .iter()
        .flat_map(|a| own.iter().map(move |b| [of_x(a), of_x(b)]));
    let outer: Vec<[usize; 2]> = if degree > 1 {
        outer.collect()
    } else {
        Vec::new()
    };
    let blocks = |of: fn(&ConstraintSpec) -> &'static [[usize; 2]]| {
        let mut pairs = outer.clone();
        for (measure, slots) in measures.iter().zip(slots) {
            let own = of(measure).iter();
            pairs.extend(own.map(|&[a, b]| [facts.of_side(slots, a), facts.of_side(slots, b)]));
        }
        kept(sorted(pairs))
    };
    let rows = |of: fn(&ConstraintSpec) -> &'static [[usize; 2]]| {
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        if degree > 1 {
            pairs.extend(own.iter().map(|e| [0, of_x(e)]));
        }
        for (measure, slots) in measures.iter().zip(slots) {
            let own = of(measure).iter();
            pairs.extend(own.map(|&[_, b]| [0, facts.of_side(slots, b)]));
        }
        kept(sorted(pairs))
    };
    let spec = ConstraintSpec {
        c: kept(c.collect()),
        wrench: measures[1].wrench,
        turns: measures.iter().filter(|m| m.turning).count(),
        d_force_dx: blocks(|m| m.d_force_dx),
        d_residual_dx: rows(|m| m.d_residual_dx),
        d_gamma_dv: rows(|m| m.d_gamma_dv),
        d_velocity_dx: rows(|m| m.d_velocity_dx),
        data: kept(data(measures, slots, degree)),
        ..facts.spec
    };
    facts.spec = spec;
    facts
}

/// The properties that are equal for all couplings.
const PLAIN: ConstraintSpec = ConstraintSpec {
    common: Spec {
        name: "Coupling",
        scene_type: TYPE,
        variant: None,
        doc: "A measure of one joint follows a measure of another, both since the start.",
        text: "",
        slots: &[],
        parameters: &[],
        points_apart: false,
        bearings: false,
        requirements: &[],
    },
    role: Role::Joint,
    rows: &[Row::keeping_start("coupling")],
    holonomic: 1,
    c: &[],
    rheonomic: false,
    wrench: &[],
    component: Some("load"),
    note: Some(
        "the load of a coupling acts along the dependent coordinate, and times the ratio along the other coordinate, without forces of teeth or threads",
    ),
    measures: &[],
    turning: false,
    turns: 0,
    d_force_dx: &[],
    d_residual_dx: &[],
    d_gamma_dv: &[],
    d_velocity_dx: &[],
    data: &[],
};

fn kept<T>(list: Vec<T>) -> &'static [T] {
    Box::leak(list.into_boxed_slice())
}

fn sorted(mut pairs: Vec<[usize; 2]>) -> Vec<[usize; 2]> {
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Returns the parameters of both joints without the motions of the drives. Functions that need the
/// points of the coupling use these parameters.
fn common(measures: [&'static ConstraintSpec; 2], slots: [[usize; 2]; 2], n_slots: usize) -> Spec {
    let mut parameters: Vec<Parameter> = Vec::new();
    for (measure, slots) in measures.iter().zip(slots) {
        let first = parameters.len();
        let own = measure.common.parameters;
        let own = own.split_last().map_or(own, |(_, own)| own);
        parameters.extend(own.iter().map(|parameter| Parameter {
            shape: match parameter.shape {
                Shape::Point { slot } => Shape::Point { slot: slots[slot] },
                Shape::Direction { slot } => Shape::Direction { slot: slots[slot] },
                Shape::Axes { slot, like } => Shape::Axes {
                    slot: slots[slot],
                    like: like.map(|like| first + like),
                },
                other => other,
            },
            ..*parameter
        }));
    }
    Spec {
        slots: &SLOTS[..n_slots],
        parameters: kept(parameters),
        ..PLAIN.common
    }
}

/// Computes the stored values of both drives, followed by the ratio and the coefficients.
fn data(
    measures: [&'static ConstraintSpec; 2],
    slots: [[usize; 2]; 2],
    degree: usize,
) -> Vec<Datum> {
    let mut data: Vec<Datum> = Vec::new();
    let mut first = 0;
    for (measure, slots) in measures.iter().zip(slots) {
        data.extend(measure.data.iter().map(|datum| {
            let shape = match datum.shape {
                DatumShape::Point { slot } => DatumShape::Point { slot: slots[slot] },
                DatumShape::Direction { slot } => DatumShape::Direction { slot: slots[slot] },
                DatumShape::Axes { slot } => DatumShape::Axes { slot: slots[slot] },
                DatumShape::KeptVector { slot } => DatumShape::KeptVector { slot: slots[slot] },
                other => other,
            };
            Datum::new(datum.name, shape, first + datum.first, datum.count)
        }));
        first += measure.n_data();
    }
    let names = ["ratio"]
        .into_iter()
        .chain(std::iter::repeat("coefficient"));
    data.extend(
        names
            .take(degree)
            .enumerate()
            .map(|(k, name)| Datum::new(name, DatumShape::Number(Unit::Ratio), first + k, 1)),
    );
    data
}
