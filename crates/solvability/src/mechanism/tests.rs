//! For any definition of a joint, each non-unique reaction of the joint has a component that is not
//! unique.

use joints::spec::{Shape, Spec};
use joints::{Argument, Plane, Space3, space3};
use model::{
    Body, BodyRef, BodySpace, ConstraintId, ConstraintKernels, ContactLimits, Description,
    Function, Joint, Mechanism, MechanismDescription, Registry, SpatialBody, SpatialDescription,
    System,
};

use crate::{ReactionVerdict, Verdict, analyse};

/// Pseudo-random numbers from −1 to 1.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = (self.0)
            .wrapping_mul(0x5851_f42d_4c95_7f2d)
            .wrapping_add(0x1405_7b7e_f767_814f);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.next())
    }

    fn below(&mut self, n: usize) -> usize {
        ((0.5 + 0.5 * self.next()) * n as f64) as usize % n
    }
}

/// A point with an axis and a perpendicular direction, all in ground axes.
struct Place {
    at: [f64; 3],
    axis: [f64; 3],
    across: [f64; 3],
}

/// A point of the ground in the frame of a body.
type Local<'l> = &'l dyn Fn(BodyRef, [f64; 3]) -> [f64; 3];

/// The arguments of a definition at a point; functions of time are separate.
fn arguments(
    spec: &Spec,
    bodies: &[BodyRef],
    is_plane: bool,
    place: &Place,
    local: Local<'_>,
) -> Vec<Argument> {
    let Place { at, axis, across } = *place;
    let vector = |[x, y, z]: [f64; 3]| {
        if is_plane {
            Argument::Pair([x, y])
        } else {
            Argument::Triple([x, y, z])
        }
    };
    let turned = |slot: usize, v: [f64; 3]| {
        let tip = local(bodies[slot], std::array::from_fn(|k| at[k] + v[k]));
        let foot = local(bodies[slot], at);
        std::array::from_fn(|k| tip[k] - foot[k])
    };
    let mut points = 0.0;
    let one = |parameter: &joints::spec::Parameter| match parameter.shape {
        Shape::Point { slot } => {
            // Points that must be separate have a distance along the axis and across the axis.
            points += f64::from(u8::from(spec.points_apart));
            let there = |k: usize| at[k] + 0.3 * points * (axis[k] + across[k]);
            vector(local(bodies[slot], std::array::from_fn(there)))
        }
        Shape::Direction { slot } => vector(turned(slot, axis)),
        Shape::Axes { slot, .. } => {
            let axes = space3::Axes::new(turned(slot, axis), Some(turned(slot, across)));
            Argument::Axes(axes.expect("across"))
        }
        Shape::GroundLine => {
            let end = |k: usize| at[k] + axis[k];
            Argument::Pairs([[at[0], at[1]], [end(0), end(1)]])
        }
        Shape::GroundPlane => Argument::Triples([at, axis]),
        Shape::Numbers(_) if parameter.optional => Argument::Absent,
        Shape::Numbers(units) => Argument::Numbers(vec![0.4; units.len()]),
        Shape::Functions(_) => Argument::Absent,
    };
    spec.parameters.iter().map(one).collect()
}

/// A space, and a mechanism in this space for this test.
trait Loops: BodySpace {
    const IS_PLANE: bool;

    fn start(draw: &mut Draw) -> MechanismDescription<Self>;
    fn local(d: &MechanismDescription<Self>, body: BodyRef, point: [f64; 3]) -> [f64; 3];
    fn definitions(registry: &Registry) -> &model::Definitions<Self>;
    fn built(d: &MechanismDescription<Self>) -> Option<Mechanism>;
}

impl Loops for Plane {
    const IS_PLANE: bool = true;

    fn start(draw: &mut Draw) -> MechanismDescription<Self> {
        let mut d = Description::new("plane");
        for k in 0..3 {
            let [x, y, angle] = draw.vector();
            d.body(Body {
                position: [x, y],
                angle,
                ..Body::new(&format!("body {k}"), 1.0, 1.0)
            });
        }
        d
    }

    fn local(d: &MechanismDescription<Self>, body: BodyRef, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let [x, y] = d.local(body, [x, y]);
        [x, y, 0.0]
    }

    fn definitions(registry: &Registry) -> &model::Definitions<Self> {
        registry.plane()
    }

    fn built(d: &MechanismDescription<Self>) -> Option<Mechanism> {
        Mechanism::build(d).ok()
    }
}

impl Loops for Space3 {
    const IS_PLANE: bool = false;

    fn start(draw: &mut Draw) -> SpatialDescription {
        let mut d = SpatialDescription::new("space");
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for k in 0..3 {
            let [x, y, z] = draw.vector();
            d.body(SpatialBody {
                position: draw.vector(),
                orientation: [1.0, x, y, z],
                ..SpatialBody::new(&format!("body {k}"), 1.0, unit)
            });
        }
        d
    }

    fn local(d: &SpatialDescription, body: BodyRef, point: [f64; 3]) -> [f64; 3] {
        d.local(body, point)
    }

    fn definitions(registry: &Registry) -> &model::Definitions<Self> {
        registry.space()
    }

    fn built(d: &SpatialDescription) -> Option<Mechanism> {
        Mechanism::build(d).ok()
    }
}

/// Selects different bodies for the slots of a definition. If there is only one slot, its body is
/// not the ground.
fn pick(draw: &mut Draw, slots: usize) -> Vec<BodyRef> {
    let mut all = vec![
        BodyRef::Body(0),
        BodyRef::Body(1),
        BodyRef::Body(2),
        BodyRef::Ground,
    ];
    if slots == 1 {
        all.pop();
    }
    (0..slots)
        .map(|_| all.remove(draw.below(all.len())))
        .collect()
}

/// Returns whether no component of a non-unique reaction shows that it is not unique.
fn is_silent(r: &ReactionVerdict) -> bool {
    let mut components = r.components.iter();
    r.wrench.verdict == Verdict::NotUnique
        && components.all(|c| c.judgement.verdict == Verdict::Unique)
}

/// Builds mechanisms with two joints of each kind at one point, a joint of another kind, and
/// couplings. A row of couplings couples all joint coordinates of both points. Returns the number
/// of non-unique reactions of each kind.
fn not_unique<S: Loops>(draw: &mut Draw, kind: &str, other: &str) -> Vec<(&'static str, usize)> {
    let registry = Registry::standard();
    let mut d = S::start(draw);
    let place = Place {
        at: draw.vector(),
        axis: draw.vector(),
        across: draw.vector(),
    };
    let mut measures = Vec::new();
    for (n, name) in [kind, kind, other].iter().enumerate() {
        let bodies_of = |slots| pick(&mut Draw(7 + draw.0 * u64::from(n == 2)), slots);
        for definition in S::definitions(&registry).constraints(name) {
            let spec = &definition.spec.common;
            let bodies = bodies_of(spec.slots.len());
            let local = |body, point| S::local(&d, body, point);
            let mut given = arguments(spec, &bodies, S::IS_PLANE, &place, &local);
            let Ok(element) = (definition.build)(&given) else {
                continue;
            };
            let functions = spec.functions().count();
            d.joints.push(Joint {
                name: format!("{name} {n} {}", spec.name),
                bodies: bodies.clone(),
                element,
                functions: vec![Function::constant(0.0).expect("a number"); functions],
                tolerance: None,
                limits: ContactLimits::default(),
            });
            given.push(Argument::Absent);
            for drive in &definition.drives {
                if let Ok(measure) = (drive.build)(&given) {
                    measures.push((bodies.clone(), measure));
                }
            }
        }
    }
    let copied = |(bodies, drive): &(Vec<BodyRef>, Box<dyn ConstraintKernels<S>>)| {
        (bodies.clone(), drive.boxed())
    };
    for k in 1..measures.len() {
        let both = [copied(&measures[k - 1]), copied(&measures[k])];
        if let Ok((bodies, element)) = S::couple(both, &[if k % 2 == 0 { 1.0 } else { -1.0 }]) {
            d.joints.push(Joint {
                name: format!("coupling {k}"),
                bodies,
                element,
                functions: Vec::new(),
                tolerance: None,
                limits: ContactLimits::default(),
            });
        }
    }
    let Some(mechanism) = S::built(&d) else {
        return Vec::new();
    };
    let (q, _) = mechanism.described_state();
    let Ok(analysis) = analyse(&mechanism, 0.0, &q) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for r in &analysis.reactions {
        assert!(!is_silent(r), "{kind}, {other}: {r:#?}");
        let count = usize::from(r.wrench.verdict == Verdict::NotUnique);
        found.push((r.kind, count));
    }
    found
}

fn all_kinds<S: Loops>() {
    let registry = Registry::standard();
    let specs = S::definitions(&registry).constraint_specs();
    let kinds: Vec<&'static str> = specs.map(|spec| spec.scene_type).collect();
    let mut counts = std::collections::BTreeMap::new();
    for (k, kind) in kinds.iter().enumerate() {
        for seed in 0..kinds.len() {
            let mut draw = Draw((100 * k + seed + 1) as u64);
            for (kind, count) in not_unique::<S>(&mut draw, kind, kinds[seed]) {
                *counts.entry(kind).or_insert(0) += count;
            }
        }
    }
    assert!(counts.get("coupling").is_some_and(|n| *n > 0), "{counts:?}");
    for kind in kinds {
        let seen = counts.get(kind).copied();
        assert!(seen.is_some_and(|n| n > 0), "{kind}: {counts:?}");
    }
}

#[test]
fn what_is_not_unique_has_a_component_that_is_not_in_the_plane() {
    all_kinds::<Plane>();
}

#[test]
fn what_is_not_unique_has_a_component_that_is_not_in_space() {
    all_kinds::<Space3>();
}

/// A swing of two arms. Its seat does not rotate, because of two couplings and because of the
/// parallelogram. The coupling of the seat loads the seat and the ground, but not the arm between
/// the seat and the ground.
#[test]
fn a_coupling_in_a_loop_has_its_own_load() {
    let mut d = Description::new("swing");
    d.gravity = [0.0, -10.0];
    let [left, right, seat] = [[0.0, -0.5], [1.0, -0.5], [0.5, -1.0]].map(|position| {
        let name = format!("body {}", d.bodies.len());
        d.body(Body {
            position,
            ..Body::new(&name, 1.0, 0.1)
        })
    });
    let pin = |s_i, s_j| joints::Revolute { s_i, s_j };
    let (top, bottom) = ([0.0, 0.5], [0.0, -0.5]);
    let pairs = [
        ("ul", [BodyRef::Ground, left], pin([0.0, 0.0], top)),
        ("ur", [BodyRef::Ground, right], pin([1.0, 0.0], top)),
        ("ll", [left, seat], pin(bottom, [-0.5, 0.0])),
        ("lr", [right, seat], pin(bottom, [0.5, 0.0])),
    ];
    for (name, bodies, pin) in &pairs {
        d.joint(name, bodies, pin.clone());
    }
    let angle = |k: usize| {
        let (_, bodies, pin) = &pairs[k];
        let drive = joints::RevoluteAngleDrive::new(pin.s_i, pin.s_j);
        let drive: Box<dyn ConstraintKernels<Plane>> = Box::new(drive);
        (bodies.to_vec(), drive)
    };
    for (name, y, ratio) in [("of right", 1, 1.0), ("of seat", 2, -1.0)] {
        let (bodies, element) = Plane::couple([angle(0), angle(y)], &[ratio]).expect("measures");
        d.joints.push(Joint {
            name: name.into(),
            bodies,
            element,
            functions: Vec::new(),
            tolerance: None,
            limits: ContactLimits::default(),
        });
    }
    let mechanism = Mechanism::build(&d).expect("it builds");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("a configuration");
    let coupling = &analysis.reactions[5];
    let words: Vec<_> = coupling
        .components
        .iter()
        .map(|c| (c.name, c.judgement.verdict.word()))
        .collect();
    assert_eq!(words, [("T", "not_unique"), ("load", "not_unique")]);
    assert_eq!(coupling.wrench.verdict.word(), "not_unique");
    assert!(!coupling.determines("load") && !coupling.determines("T"));
    let other = &analysis.reactions[4];
    assert!(
        other
            .components
            .iter()
            .any(|c| c.name == "T" && !c.judgement.verdict.is_unique())
    );
    assert_eq!(analysis.reactions[5].id, ConstraintId(5));
    assert_eq!(mechanism.layout().groups[5].own_load(), Some("load"));
}
