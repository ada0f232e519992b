//! Tests that the macro in a crate of a user gives the same results as the code of the library.
//! Every definition of the library is passed to `joint!` or `force!` here; specifications and
//! kernels must agree with those of the crate `joints`, bit for bit.

use joints::{
    Argument, Constraint, ConstraintSpec, Force, ForceSpec, Pose, SlopedOutputs, Twist, Visitor,
    plane_constraints, plane_forces,
};

/// Creates one module for each definition file; its content is the text of the file.
macro_rules! own {
    ($($module:ident)*) => { $(
        mod $module {
            #[allow(unused_imports)]
            use pfaff_joint_macro::{force, joint};
            include!(concat!("../../joints/definitions/", stringify!($module), ".rs"));
        }
    )* };
}

own! {
    angle bushing damper distance fixed gear knife_edge mesh pin_in_slot point_force point_on_line
    rack_and_pinion revolute rolling spring_damper torque torque_between torsion_spring_damper
    translational tyre velocity
}

fn own_constraints<V: Visitor>(visitor: &mut V) {
    visitor.constraint::<angle::Angle>();
    visitor.constraint::<distance::Distance>();
    visitor.constraint::<fixed::Fixed>();
    visitor.constraint::<gear::Gear>();
    visitor.constraint::<knife_edge::KnifeEdge>();
    visitor.constraint::<mesh::Mesh>();
    visitor.constraint::<pin_in_slot::PinInSlot>();
    visitor.constraint::<point_on_line::PointOnLine>();
    visitor.constraint::<rack_and_pinion::RackAndPinion>();
    visitor.constraint::<rolling::RelativeRolling>();
    visitor.constraint::<revolute::Revolute>();
    visitor.constraint::<rolling::Rolling>();
    visitor.constraint::<translational::Translational>();
    visitor.constraint::<velocity::Velocity>();
}

fn own_forces<V: Visitor>(visitor: &mut V) {
    visitor.force::<point_force::BodyPointForce>();
    visitor.force::<bushing::Bushing>();
    visitor.force::<damper::Damper>();
    visitor.force::<point_force::PointForce>();
    visitor.force::<spring_damper::SpringDamper>();
    visitor.force::<torque::Torque>();
    visitor.force::<torque_between::TorqueBetween>();
    visitor.force::<torsion_spring_damper::TorsionSpringDamper>();
    visitor.force::<tyre::Tyre>();
}

/// Number of poses that are tested for each definition.
const POSES: u64 = 20;

/// Specifications and values of definitions, in the order in which the definitions are visited.
#[derive(Default)]
struct Record {
    facts: Vec<String>,
    bits: Vec<(&'static str, Vec<u64>)>,
}

impl Visitor for Record {
    fn constraint<K: Constraint>(&mut self) {
        self.facts.push(format!("{:#?}", K::SPEC));
        for seed in 0..POSES {
            self.bits
                .push((K::SPEC.common.name, constraint_bits::<K>(seed)));
        }
        K::visit_drives(self);
    }

    fn drive<K: Constraint>(&mut self) {
        self.constraint::<K>();
    }

    fn force<K: Force>(&mut self) {
        self.facts.push(format!("{:#?}", K::SPEC));
        for seed in 0..POSES {
            self.bits.push((K::SPEC.common.name, force_bits::<K>(seed)));
        }
    }
}

#[test]
fn constraints_have_the_same_facts_and_the_same_bits() {
    let (mut own, mut shipped) = (Record::default(), Record::default());
    own_constraints(&mut own);
    plane_constraints(&mut shipped);
    compare(&own, &shipped);
}

#[test]
fn forces_have_the_same_facts_and_the_same_bits() {
    let (mut own, mut shipped) = (Record::default(), Record::default());
    own_forces(&mut own);
    plane_forces(&mut shipped);
    compare(&own, &shipped);
}

fn compare(own: &Record, shipped: &Record) {
    assert_eq!(
        own.facts.len(),
        shipped.facts.len(),
        "a definition is missing in this test"
    );
    for (a, b) in own.facts.iter().zip(&shipped.facts) {
        assert_eq!(a, b);
    }
    for ((name, a), (_, b)) in own.bits.iter().zip(&shipped.bits) {
        assert_eq!(a, b, "{name}");
        assert!(!a.is_empty(), "{name}");
    }
    assert_eq!(own.bits.len(), shipped.bits.len());
}

/// Pseudo-random numbers in [−2, 2) from a seed (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 51) as f64 - 2.0
    }

    fn array<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.next())
    }

    fn poses(&mut self, n: usize) -> Vec<Pose> {
        (0..n)
            .map(|_| Pose::new(self.next(), self.next(), 2.0 * self.next()))
            .collect()
    }

    fn twists(&mut self, n: usize) -> Vec<Twist> {
        (0..n)
            .map(|_| Twist {
                x: self.next(),
                y: self.next(),
                omega: self.next(),
            })
            .collect()
    }

    fn arguments(&mut self, spec: &joints::spec::Spec) -> Vec<Argument> {
        use joints::spec::Shape;
        let parameters = spec.parameters.iter();
        parameters
            .map(|p| match p.shape {
                Shape::Point { .. } | Shape::Direction { .. } => Argument::Pair(self.array()),
                Shape::Axes { .. } | Shape::GroundPlane => Argument::Absent,
                Shape::GroundLine => Argument::Pairs([self.array(), self.array()]),
                // Every second optional parameter is given.
                Shape::Numbers(_) if p.optional && self.next() < 0.0 => Argument::Absent,
                Shape::Numbers(units) => {
                    Argument::Numbers(units.iter().map(|_| self.next().abs()).collect())
                }
                Shape::Functions(_) => Argument::Absent,
            })
            .collect()
    }
}

fn constraint_bits<K: Constraint>(seed: u64) -> Vec<u64> {
    const BUFFER: usize = 64;
    let spec: ConstraintSpec = K::SPEC;
    let mut numbers = Numbers(seed);
    let arguments = numbers.arguments(&spec.common);
    let mut k = K::from_arguments(&arguments).expect("the arguments follow the facts");
    let n = spec.common.slots.len();
    k.initialise(&numbers.poses(n));
    let (x, v, a) = (numbers.poses(n), numbers.twists(n), numbers.twists(n));
    let f: Vec<[f64; 3]> = spec.common.functions().map(|_| numbers.array()).collect();
    let lambda = numbers.array::<8>();
    let mut out = Vec::new();
    // The kernels write the entries of their patterns; the rest of the buffer must not change in
    // either case.
    let mut call = |kernel: &dyn Fn(&mut [f64])| {
        let mut values = [7.0; BUFFER];
        kernel(&mut values);
        out.extend(values.map(f64::to_bits));
    };
    call(&|o| k.phi(&x, &f, o));
    call(&|o| k.c_constant(o));
    call(&|o| k.c(&x, &f, o));
    call(&|o| k.b(&x, &f, o));
    call(&|o| k.gamma(&x, &v, &f, o));
    call(&|o| k.wrench(&x, &f, o));
    call(&|o| k.component(&x, &f, o));
    call(&|o| o[..2].copy_from_slice(&k.place(&x)));
    call(&|o| k.d_force_dx(&x, &f, &lambda, o));
    call(&|o| k.d_residual_dx(&x, &v, &a, &f, o));
    call(&|o| k.d_gamma_dv(&x, &v, &f, o));
    call(&|o| k.d_velocity_dx(&x, &v, &f, o));
    call(&|o| k.data(o));
    let slopes = k.slopes(&x, &f, SlopedOutputs::All(&v));
    let accelerations: Vec<f64> = a.iter().flat_map(|a| [a.x, a.y, a.omega]).collect();
    call(&|o| slopes.phi(&lambda, &mut o[..spec.n_data()]));
    call(&|o| slopes.residual(&lambda, &accelerations, &mut o[..spec.n_data()]));
    let mut numbers = [0.0; BUFFER];
    k.data(&mut numbers);
    numbers.iter_mut().for_each(|number| *number += 0.25);
    k.set_data(&numbers);
    call(&|o| k.data(o));
    call(&|o| k.phi(&x, &f, o));
    out.extend((0..spec.common.requirements.len()).map(|r| u64::from(k.requirement(r, &x))));
    out
}

fn force_bits<K: Force>(seed: u64) -> Vec<u64> {
    const BUFFER: usize = 64;
    let spec: ForceSpec = K::SPEC;
    let mut numbers = Numbers(seed);
    let arguments = numbers.arguments(&spec.common);
    let mut k = K::from_arguments(&arguments).expect("the arguments follow the facts");
    let n = spec.common.slots.len();
    k.initialise(&numbers.poses(n));
    let (x, v) = (numbers.poses(n), numbers.twists(n));
    let f: Vec<[f64; 3]> = spec.common.functions().map(|_| numbers.array()).collect();
    let mut out = Vec::new();
    let mut call = |kernel: &dyn Fn(&mut [f64])| {
        let mut values = [7.0; BUFFER];
        kernel(&mut values);
        out.extend(values.map(f64::to_bits));
    };
    call(&|o| k.q(&x, &v, &f, o));
    call(&|o| k.dq_dx(&x, &v, &f, o));
    call(&|o| k.dq_dv(&x, &v, &f, o));
    out.extend((0..spec.common.requirements.len()).map(|r| u64::from(k.requirement(r, &x))));
    out
}
