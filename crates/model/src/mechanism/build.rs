//! From a description to a mechanism. All faults of a description are found at once.

use crate::codes::Code;
use std::collections::HashSet;

use joints::spec::{ConstraintSpec, Level, Role, Spec};
use joints::{LARGEST, is_usable};

use super::check;
use super::work::held_bodies;
use super::{Elements, FunctionForm, Mechanism, TimeFunction, initialise};
use crate::body::{Body, BodyRecord, BodyRef, DescribedBody, SpatialBody};
use crate::description::Described;
use crate::element::{
    AnyConstraint, AnyForce, BodySpace, ConstraintKernels, PlacedConstraint, PlacedForce, Site,
};
use crate::function::Function;
use crate::group::{ConstraintGroup, ConstraintKind};
use crate::observed::Observed;
use crate::space::SpaceKind;
use crate::system::{Layout, RowLabel};
use crate::tolerance::{Stated, Tolerance};

/// One fault of a description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// There is no body.
    #[error("a mechanism needs at least one body")]
    NoBodies,
    /// Two items have the same name.
    #[error("the name `{name}` is used twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// The name of the ground is reserved.
    #[error("`ground` is the name of the ground and is always there")]
    Ground,
    /// A number of a body is NaN or infinite.
    #[error("body `{body}`: {field} is {value:?}, need finite numbers up to {LARGEST:e}")]
    NotFinite {
        /// The body.
        body: String,
        /// Name of the number.
        field: &'static str,
        /// The number.
        value: f64,
    },
    /// A velocity is that of a point other than the centre of mass, and the rotation that it needs
    /// is not given.
    #[error(
        "body `{body}`: `velocity` is that of the origin of its frame, which is not its centre of mass, so `angular_velocity` is needed with it"
    )]
    VelocityAlone {
        /// The body.
        body: String,
    },
    /// A mass or an inertia is negative.
    #[error("body `{body}`: {field} is {value}, need a number ≥ 0")]
    Negative {
        /// The body.
        body: String,
        /// Name of the number.
        field: &'static str,
        /// The number.
        value: f64,
    },
    /// Gravity is NaN or infinite.
    #[error("gravity is {gravity:?}, need finite numbers up to {LARGEST:e}")]
    Gravity {
        /// Its components.
        gravity: Vec<f64>,
    },
    /// A quaternion of length zero.
    #[error("body `{body}`: the quaternion of its orientation is zero")]
    NoOrientation {
        /// The body.
        body: String,
    },
    /// A tensor of inertia is not symmetric.
    #[error("body `{body}`: the tensor of inertia is not symmetric")]
    NotSymmetric {
        /// The body.
        body: String,
    },
    /// A tensor of inertia has products.
    #[error(
        "body `{body}`: products of inertia are not supported yet: turn its frame into the principal axes, where the tensor is diagonal"
    )]
    NotPrincipal {
        /// The body.
        body: String,
    },
    /// No body has this tensor of inertia.
    #[error(
        "body `{body}`: no body has the principal moments {moments:?}: the largest is above the sum of the others"
    )]
    NoSuchTensor {
        /// The body.
        body: String,
        /// The principal moments (kg·m²).
        moments: [f64; 3],
    },
    /// A tolerance is not a finite number > 0 up to [`LARGEST`].
    #[error("{of}: {field} is {value:?}, need a finite number > 0 up to {LARGEST:e}")]
    Tolerance {
        /// The item for which it is stated.
        of: Stated,
        /// Name of the number.
        field: &'static str,
        /// The number.
        value: f64,
    },
    /// A joint, drive or force has another number of bodies than its definition.
    #[error("`{name}` connects {found} bodies, `{definition}` needs {expected}")]
    BodyCount {
        /// The joint, drive or force.
        name: String,
        /// Its definition.
        definition: &'static str,
        /// Number of slots.
        expected: usize,
        /// Number of bodies given.
        found: usize,
    },
    /// A body does not exist.
    #[error("`{name}` refers to body number {body}; there are {n_bodies}, counted from 0")]
    UnknownBody {
        /// The joint, drive or force.
        name: String,
        /// Its index.
        body: usize,
        /// Number of bodies.
        n_bodies: usize,
    },
    /// A joint connects a body with itself.
    #[error("`{name}` connects `{body}` with itself")]
    SameBody {
        /// The joint, drive or force.
        name: String,
        /// The body.
        body: String,
    },
    /// A joint or force has no moving body.
    #[error("`{name}` connects the ground with itself")]
    GroundOnly {
        /// The joint, drive or force.
        name: String,
    },
    /// A point of a joint, drive or force is NaN or infinite.
    #[error("`{name}`: a point is {point:?}, need finite numbers up to {LARGEST:e}")]
    Point {
        /// The joint, drive or force.
        name: String,
        /// Its components.
        point: Vec<f64>,
    },
    /// A number of a marker is NaN or infinite.
    #[error(
        "marker `{name}` is at [{x:?}, {y:?}], turned by {angle:?}, need finite numbers up to {LARGEST:e}"
    )]
    Marker {
        /// The marker.
        name: String,
        /// Its x coordinate.
        x: f64,
        /// Its y coordinate.
        y: f64,
        /// Its angle.
        angle: f64,
    },
    /// A marker does not exist.
    #[error(
        "measure `{name}` refers to marker number {marker}; there are {n_markers}, counted from 0"
    )]
    UnknownMarker {
        /// The measure.
        name: String,
        /// Index of the marker.
        marker: usize,
        /// Number of markers.
        n_markers: usize,
    },
    /// A measure is that of a marker relative to itself.
    #[error("measure `{name}` is between a place and itself")]
    SameMarker {
        /// The measure.
        name: String,
    },
    /// A drive is in the list of joints, or a joint in the list of drives.
    #[error("`{name}` is in the list of {list}, but `{definition}` does not belong there")]
    Role {
        /// The joint or drive.
        name: String,
        /// Its definition.
        definition: &'static str,
        /// The list that contains it.
        list: &'static str,
    },
    /// The number of functions of time differs from that of the definition.
    #[error("`{name}` has {found} functions of time, `{definition}` needs {expected}")]
    FunctionCount {
        /// The joint or force.
        name: String,
        /// Its definition.
        definition: &'static str,
        /// Number of functions of the definition.
        expected: usize,
        /// Number of functions given.
        found: usize,
    },
}

impl BuildError {
    /// Its code; see [`crate::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NoBodies { .. } => const { Code::new(120) },
            Self::DuplicateName { .. } => const { Code::new(104) },
            Self::Ground { .. } => const { Code::new(121) },
            Self::NotFinite { .. } => const { Code::new(122) },
            Self::Negative { .. } => const { Code::new(123) },
            Self::Gravity { .. } => const { Code::new(124) },
            Self::Tolerance { .. } => const { Code::new(125) },
            Self::BodyCount { .. } => const { Code::new(126) },
            Self::UnknownBody { .. } => const { Code::new(127) },
            Self::SameBody { .. } => const { Code::new(128) },
            Self::GroundOnly { .. } => const { Code::new(129) },
            Self::Point { .. } => const { Code::new(130) },
            Self::Role { .. } => const { Code::new(131) },
            Self::FunctionCount { .. } => const { Code::new(132) },
            Self::VelocityAlone { .. } => const { Code::new(133) },
            Self::Marker { .. } => const { Code::new(134) },
            Self::UnknownMarker { .. } => const { Code::new(135) },
            Self::SameMarker { .. } => const { Code::new(136) },
            Self::NoOrientation { .. } => const { Code::new(152) },
            Self::NotSymmetric { .. } | Self::NoSuchTensor { .. } => const { Code::new(153) },
            Self::NotPrincipal { .. } => const { Code::new(154) },
        }
    }
}

impl Mechanism {
    /// Assembles a mechanism. Initial values are those of the described configuration until
    /// [`crate::start::assemble`] has found a consistent one.
    ///
    /// # Errors
    /// All faults of the description.
    pub fn build<S: BodySpace>(d: &Described<S>) -> Result<Self, Vec<BuildError>> {
        let mut errors = Vec::new();
        check_bodies(d, &mut errors);
        check_names(d, &mut errors);
        check_places(d, &mut errors);
        check_tolerances(d, &mut errors);
        check::observed(d, &mut errors);
        if !errors.is_empty() {
            return Err(errors);
        }
        let mut b = Builder::new(S::KIND);
        b.joints(d, Level::Holonomic);
        for drive in &d.drives {
            b.constraint(
                &drive.name,
                ConstraintKind::Drive,
                &drive.bodies,
                S::any_constraint(drive.element.clone()),
                std::slice::from_ref(&drive.motion),
                drive.tolerance,
            );
        }
        b.layout.m = b.layout.labels.len();
        b.joints(d, Level::Nonholonomic);
        b.layout.h = b.layout.labels.len() - b.layout.m;
        for f in &d.forces {
            let kernels = S::any_force(f.element.clone());
            b.force(&f.name, &f.bodies, kernels, &f.functions);
        }
        let records = d.bodies.iter().cloned().map(Into::<DescribedBody>::into);
        let bodies: Vec<BodyRecord> = records.map(BodyRecord::from).collect();
        let (space, gravity) = (S::KIND, S::point(d.gravity));
        let weight = bodies.iter().flat_map(|b| {
            let of_axis = move |k: usize| {
                if k < space.n_translations() {
                    b.mass * gravity[k]
                } else {
                    0.0
                }
            };
            (0..space.n_v()).map(of_axis)
        });
        let weight = weight.collect();
        let mut mechanism = b.finish(&d.name, bodies, weight);
        mechanism.tolerance = d.tolerance;
        mechanism.observed = d.observed.clone();
        let (q, _) = mechanism.described_state();
        initialise(&mut mechanism, &q);
        Ok(mechanism)
    }

    /// Sets the tolerance of its numbers, unless one is stated for their joint or body.
    ///
    /// # Errors
    /// [`BuildError::Tolerance`]: it is not a finite number > 0; then nothing changes.
    pub fn set_tolerance(&mut self, tolerance: Tolerance) -> Result<(), BuildError> {
        check_tolerance(tolerance)?;
        self.tolerance = tolerance;
        Ok(())
    }
}

/// Whether a number is not a valid tolerance.
fn is_wrong(value: &f64) -> bool {
    !(is_usable(*value) && *value > 0.0)
}

/// Checks that the tolerances of the scene are finite and positive.
fn check_tolerance(tolerance: Tolerance) -> Result<(), BuildError> {
    let fields = [
        ("tolerance", tolerance.length),
        ("angle tolerance", tolerance.angle),
    ];
    let mut wrong = fields
        .into_iter()
        .filter_map(|(field, value)| Some((field, value.filter(is_wrong)?)));
    wrong.next().map_or(Ok(()), |(field, value)| {
        Err(BuildError::Tolerance {
            of: Stated::Scene,
            field,
            value,
        })
    })
}

/// Reports every tolerance of a description that is not a finite number > 0.
fn check_tolerances<S: BodySpace>(d: &Described<S>, errors: &mut Vec<BuildError>) {
    errors.extend(check_tolerance(d.tolerance).err());
    let bodies = records(d);
    let bodies = bodies
        .into_iter()
        .map(|b| (b.tolerance, Stated::Body(b.name)));
    let joints = d.joints.iter();
    let joints = joints.map(|j| (j.tolerance, Stated::Joint(j.name.clone())));
    let drives = d.drives.iter();
    let drives = drives.map(|x| (x.tolerance, Stated::Drive(x.name.clone())));
    let markers = d.observed.markers.iter();
    let markers = markers.map(|m| (m.tolerance, Stated::Marker(m.name.clone())));
    for (value, of) in bodies.chain(joints).chain(drives).chain(markers) {
        if let Some(value) = value.filter(is_wrong) {
            let field = "tolerance";
            errors.push(BuildError::Tolerance { of, field, value });
        }
    }
}

/// The bodies of a description, whatever their space.
fn records<S: BodySpace>(d: &Described<S>) -> Vec<BodyRecord> {
    let bodies = d.bodies.iter().cloned().map(Into::<DescribedBody>::into);
    bodies.map(BodyRecord::from).collect()
}

fn check_bodies<S: BodySpace>(d: &Described<S>, errors: &mut Vec<BuildError>) {
    if d.bodies.is_empty() {
        errors.push(BuildError::NoBodies);
    }
    let gravity = S::point(d.gravity);
    if !gravity.iter().all(|g| is_usable(*g)) {
        let gravity = gravity[..S::DIM].to_vec();
        errors.push(BuildError::Gravity { gravity });
    }
    for record in records(d) {
        let fields: Vec<(&'static str, f64)> = match &record.described {
            DescribedBody::Plane(b) => planar_numbers(b),
            DescribedBody::Space3(b) => spatial_numbers(b),
        };
        let before = errors.len();
        for (field, value) in fields {
            let body = record.name.clone();
            if !is_usable(value) {
                errors.push(BuildError::NotFinite { body, field, value });
            } else if value < 0.0 && matches!(field, "mass" | "inertia") {
                errors.push(BuildError::Negative { body, field, value });
            }
        }
        match &record.described {
            DescribedBody::Plane(b)
                if b.velocity.is_some() && b.angular_velocity.is_none() && !b.is_centred() =>
            {
                let body = record.name.clone();
                errors.push(BuildError::VelocityAlone { body });
            }
            DescribedBody::Plane(_) => {}
            DescribedBody::Space3(b) if errors.len() == before => {
                errors.extend(check_spatial(b));
            }
            DescribedBody::Space3(_) => {}
        }
    }
}

fn planar_numbers(b: &Body) -> Vec<(&'static str, f64)> {
    vec![
        ("mass", b.mass),
        ("inertia", b.inertia),
        ("position", b.position[0]),
        ("position", b.position[1]),
        ("centre", b.centre[0]),
        ("centre", b.centre[1]),
        ("angle", b.angle),
        ("velocity", b.velocity.unwrap_or_default()[0]),
        ("velocity", b.velocity.unwrap_or_default()[1]),
        ("angular velocity", b.angular_velocity.unwrap_or_default()),
    ]
}

fn spatial_numbers(b: &SpatialBody) -> Vec<(&'static str, f64)> {
    let all = |field: &'static str, values: &[f64]| -> Vec<(&'static str, f64)> {
        values.iter().map(|value| (field, *value)).collect()
    };
    let diagonal = [0, 1, 2].map(|k| b.inertia[k][k]);
    let products = [b.inertia[0][1], b.inertia[0][2], b.inertia[1][2]];
    [
        all("mass", &[b.mass]),
        all("inertia", &diagonal),
        all("product of inertia", &products),
        all("position", &b.position),
        all("centre", &b.centre),
        all("orientation", &b.orientation),
        all("velocity", &b.velocity.unwrap_or_default()),
        all("angular velocity", &b.angular_velocity.unwrap_or_default()),
    ]
    .concat()
}

/// Parts of the trace that principal moments may break the inequality of the triangle by.
const TRIANGLE: f64 = 1e-2;

/// Faults of a spatial body with finite numbers.
fn check_spatial(b: &SpatialBody) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let body = || b.name.clone();
    if b.orientation.iter().all(|e| *e == 0.0) {
        errors.push(BuildError::NoOrientation { body: body() });
    }
    let pairs = [[0, 1], [0, 2], [1, 2]];
    if pairs
        .iter()
        .any(|&[i, j]| b.inertia[i][j] != b.inertia[j][i])
    {
        errors.push(BuildError::NotSymmetric { body: body() });
    } else if pairs.iter().any(|&[i, j]| b.inertia[i][j] != 0.0) {
        errors.push(BuildError::NotPrincipal { body: body() });
    } else {
        let moments = [0, 1, 2].map(|k| b.inertia[k][k]);
        let trace: f64 = moments.iter().sum();
        let largest = moments.into_iter().fold(0.0, f64::max);
        if 2.0 * largest - trace > TRIANGLE * trace {
            let body = body();
            errors.push(BuildError::NoSuchTensor { body, moments });
        }
    }
    if b.velocity.is_some() && b.angular_velocity.is_none() && b.centre != [0.0; 3] {
        errors.push(BuildError::VelocityAlone { body: body() });
    }
    errors
}

fn check_names<S: BodySpace>(d: &Described<S>, errors: &mut Vec<BuildError>) {
    let mut seen = HashSet::new();
    let records = records(d);
    let bodies = records.iter().map(|b| &b.name);
    let markers = d.observed.markers.iter().map(|m| &m.name);
    let measures = d.observed.measures.iter().map(|m| &m.name);
    let bodies = bodies
        .chain(markers)
        .chain(measures)
        .map(|name| (name, "body"));
    let others = d
        .joints
        .iter()
        .map(|j| &j.name)
        .chain(d.drives.iter().map(|x| &x.name))
        .chain(d.forces.iter().map(|f| &f.name))
        .map(|name| (name, "joint"));
    for (name, space) in bodies.chain(others) {
        if name == "ground" {
            errors.push(BuildError::Ground);
        } else if !seen.insert((name, space)) {
            errors.push(BuildError::DuplicateName { name: name.clone() });
        }
    }
}

fn check_places<S: BodySpace>(d: &Described<S>, errors: &mut Vec<BuildError>) {
    let records = records(d);
    let constraint = |element: &dyn ConstraintKernels<S>| (element.spec(), element.points());
    for j in &d.joints {
        let (spec, points) = constraint(j.element.as_ref());
        check_role(&j.name, spec, Role::Joint, "joints", errors);
        // A named component is that of the force on the first slot only.
        let on_ground = j.bodies.split_first().is_some_and(|(first, others)| {
            *first == BodyRef::Ground && others.contains(&BodyRef::Ground)
        });
        if on_ground && spec.component.is_some() {
            let (name, body) = (j.name.clone(), "ground".to_owned());
            errors.push(BuildError::SameBody { name, body });
        }
        let takes = (&points[..], j.functions.len());
        check_place::<S>(&records, &j.name, &spec.common, &j.bodies, takes, errors);
    }
    for x in &d.drives {
        let (spec, points) = constraint(x.element.as_ref());
        check_role(&x.name, spec, Role::Drive, "drives", errors);
        check_place::<S>(
            &records,
            &x.name,
            &spec.common,
            &x.bodies,
            (&points, 1),
            errors,
        );
    }
    for f in &d.forces {
        let (spec, points) = (&f.element.spec().common, f.element.points());
        let takes = (&points[..], f.functions.len());
        check_place::<S>(&records, &f.name, spec, &f.bodies, takes, errors);
    }
}

fn check_role(
    name: &str,
    spec: &ConstraintSpec,
    role: Role,
    list: &'static str,
    errors: &mut Vec<BuildError>,
) {
    if spec.role != role {
        errors.push(BuildError::Role {
            name: name.to_owned(),
            definition: spec.common.name,
            list,
        });
    }
}

fn check_place<S: BodySpace>(
    all: &[BodyRecord],
    name: &str,
    spec: &'static Spec,
    bodies: &[BodyRef],
    (points, functions): (&[S::Vector<f64>], usize),
    errors: &mut Vec<BuildError>,
) {
    let name = || name.to_owned();
    let is_none = |p: &&S::Vector<f64>| !p.as_ref().iter().all(|x| is_usable(*x));
    if let Some(point) = points.iter().find(is_none) {
        let point = point.as_ref().to_vec();
        errors.push(BuildError::Point {
            name: name(),
            point,
        });
    }
    if bodies.len() != spec.slots.len() {
        let (expected, found) = (spec.slots.len(), bodies.len());
        errors.push(BuildError::BodyCount {
            name: name(),
            definition: spec.name,
            expected,
            found,
        });
    }
    let expected = spec.functions().count();
    if functions != expected {
        let definition = spec.name;
        errors.push(BuildError::FunctionCount {
            name: name(),
            definition,
            expected,
            found: functions,
        });
    }
    for (k, &body) in bodies.iter().enumerate() {
        if let BodyRef::Body(body) = body
            && body >= all.len()
        {
            errors.push(BuildError::UnknownBody {
                name: name(),
                body,
                n_bodies: all.len(),
            });
        } else if let BodyRef::Body(at) = body
            && bodies[..k].contains(&body)
        {
            errors.push(BuildError::SameBody {
                name: name(),
                body: all[at].name.clone(),
            });
        }
    }
    if bodies.iter().all(|b| *b == BodyRef::Ground) {
        errors.push(BuildError::GroundOnly { name: name() });
    }
}

/// Extends the lists of a mechanism, element by element.
pub(super) struct Builder {
    elements: Elements,
    pub(super) layout: Layout,
}

impl Builder {
    pub(super) fn new(space: SpaceKind) -> Self {
        Self {
            elements: Elements::default(),
            layout: Layout {
                space,
                ..Layout::default()
            },
        }
    }

    /// Adds the joints of one level.
    fn joints<S: BodySpace>(&mut self, d: &Described<S>, level: Level) {
        for j in d.joints.iter().filter(|j| j.element.spec().level == level) {
            let (name, element) = (&j.name, S::any_constraint(j.element.clone()));
            let kind = ConstraintKind::Joint;
            self.constraint(name, kind, &j.bodies, element, &j.functions, j.tolerance);
        }
    }

    pub(super) fn constraint(
        &mut self,
        name: &str,
        kind: ConstraintKind,
        bodies: &[BodyRef],
        element: AnyConstraint,
        functions: &[Function],
        tolerance: Option<f64>,
    ) {
        let spec = element.spec();
        let first_row = self.layout.labels.len();
        let rows = first_row..first_row + spec.rows.len();
        let first_entry = self.elements.entries.len();
        let entries = first_entry..first_entry + spec.c.len();
        self.elements.entries.resize(entries.end, 0.0);
        element.c_constant(&mut self.elements.entries[entries.clone()]);
        for (k, row) in spec.rows.iter().enumerate() {
            self.layout.labels.push(RowLabel {
                number: first_row + k + 1,
                joint: name.to_owned(),
                row: row.name,
            });
            self.pattern_row(
                bodies,
                spec.c
                    .iter()
                    .enumerate()
                    .filter(|(_, e)| e.row == k)
                    .map(|(at, e)| (e.slot, e.dof, first_entry + at)),
            );
        }
        let offset = |f: &Function| match kind {
            ConstraintKind::Drive => f.jet(0.0)[0],
            ConstraintKind::Joint => 0.0,
        };
        let site = self.site(bodies, functions, offset, spec.turning);
        let places = [entries, rows.clone()];
        let placed = PlacedConstraint::new(element, site, places, tolerance);
        self.layout.rheonomic |= spec.rheonomic;
        self.layout.groups.push(ConstraintGroup {
            space: self.layout.space,
            name: name.to_owned(),
            kind,
            spec,
            bodies: bodies.to_vec(),
            rows,
        });
        self.elements.constraints.push(placed);
    }

    pub(super) fn force(
        &mut self,
        name: &str,
        bodies: &[BodyRef],
        element: AnyForce,
        functions: &[Function],
    ) {
        let spec = element.spec();
        let site = self.site(bodies, functions, |_| 0.0, false);
        let placed = PlacedForce::new(name, element, site);
        self.elements.block = self.elements.block.max(spec.q.len());
        self.elements.forces.push(placed);
    }

    /// One row of the pattern of C, from (slot, degree of freedom, index of the entry).
    fn pattern_row(
        &mut self,
        bodies: &[BodyRef],
        entries: impl Iterator<Item = (usize, usize, usize)>,
    ) {
        let columns = self.layout.space.n_v();
        let pattern = &mut self.layout.pattern;
        if pattern.start.is_empty() {
            pattern.start.push(0);
        }
        for (slot, dof, entry) in entries {
            if let BodyRef::Body(body) = bodies[slot] {
                pattern.column.push(columns * body + dof);
                pattern.entry.push(entry);
            }
        }
        pattern.start.push(pattern.column.len());
    }

    /// The next slots, for these bodies and functions of time; `offset` is subtracted from the
    /// functions, which enter by cosine and sine if `turning`.
    fn site(
        &mut self,
        bodies: &[BodyRef],
        functions: &[Function],
        offset: impl Fn(&Function) -> f64,
        turning: bool,
    ) -> Site {
        let (first_slot, first) = (self.elements.n_slots, self.elements.functions.len());
        self.elements.n_slots += bodies.len();
        for function in functions {
            self.layout.break_times.extend(function.break_times());
            let forms: &[FunctionForm] = if turning {
                &[FunctionForm::Cosine, FunctionForm::Sine]
            } else {
                &[FunctionForm::Value]
            };
            let functions = forms.iter().map(|&form| TimeFunction {
                function: function.clone(),
                offset: offset(function),
                form,
            });
            self.elements.functions.extend(functions);
        }
        Site {
            space: self.layout.space,
            bodies: bodies.to_vec(),
            slots: first_slot..self.elements.n_slots,
            functions: first..self.elements.functions.len(),
        }
    }

    /// The mechanism of these bodies; initial values and arms are not yet set.
    pub(super) fn finish(
        mut self,
        name: &str,
        bodies: Vec<BodyRecord>,
        weight: Vec<f64>,
    ) -> Mechanism {
        let space = self.layout.space;
        self.layout.n_q = space.n_q() * bodies.len();
        self.layout.n_v = space.n_v() * bodies.len();
        if self.layout.pattern.start.is_empty() {
            self.layout.pattern.start.push(0);
        }
        self.layout.break_times.sort_by(f64::total_cmp);
        self.layout.break_times.dedup();
        let mass = bodies.iter();
        Mechanism {
            name: name.to_owned(),
            mass: mass.flat_map(inertia).collect(),
            weight,
            tolerance: Tolerance::default(),
            observed: Observed::default(),
            reach: vec![0.0; bodies.len()],
            held: held_bodies(&self.elements, &self.layout, bodies.len()),
            elements: self.elements,
            layout: self.layout,
            bodies,
        }
    }
}

#[cfg(test)]
mod tests;

/// The diagonal of M of a body.
fn inertia(body: &BodyRecord) -> Vec<f64> {
    let m = body.mass;
    match &body.described {
        DescribedBody::Plane(b) => vec![m, m, b.inertia],
        DescribedBody::Space3(b) => {
            vec![m, m, m, b.inertia[0][0], b.inertia[1][1], b.inertia[2][2]]
        }
    }
}
