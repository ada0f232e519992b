//! Cases with random parameters, poses and motions that agree with the specification of a
//! definition. Some cases are ordinary, and the other cases have special properties.

use std::fmt;

use joints::Argument;
use joints::spec::{Parameter, Shape, Spec, Unit};

use crate::bodies::{Bodies, axes};

/// Number of ordinary cases in one check.
pub const ORDINARY_CASES: usize = 1000;
/// Number of cases with each special property in one check.
pub const AWKWARD_CASES: usize = 25;
/// Number of motions of one case. If a constraint has only one row, its right-hand side can be zero
/// for one motion by chance. The relative error of this motion is then meaningless. It is unlikely
/// that the right-hand sides of several motions are all zero.
pub(crate) const MOTIONS: usize = 4;

/// Largest magnitude of the coordinates of ordinary poses.
const REACH: f64 = 2.0;

/// The special property of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// The case has no special property. Coordinates are within ±2, and angles are within ±π.
    Ordinary,
    /// All frames have the same orientation.
    ParallelFrames,
    /// Angles are 0, ±π/2 or ±π, and in space also ±2π/3. Directions are along the axes of the
    /// frame.
    RightAngles,
    /// Angles differ from ±π by 1e-9.
    NearPi,
    /// Angles are about ±1000; in space, the length of quaternions is about 1000.
    LargeAngles,
    /// Coordinates are within ±1000.
    FarApart,
    /// Coordinates are within ±2 of a point at a distance of 1000.
    FarTogether,
    /// All points are at the origins of their frames.
    ZeroOffsets,
    /// All bodies have the same pose.
    Coincident,
    /// All bodies have the same pose, and all points are at the origins of their frames.
    CoincidentPoints,
    /// All bodies are at rest.
    AtRest,
}

impl Kind {
    const AWKWARD: [Self; 10] = [
        Self::ParallelFrames,
        Self::RightAngles,
        Self::NearPi,
        Self::LargeAngles,
        Self::FarApart,
        Self::FarTogether,
        Self::ZeroOffsets,
        Self::Coincident,
        Self::CoincidentPoints,
        Self::AtRest,
    ];
}

/// Velocities and accelerations, one for each velocity component of each body, and the multipliers.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
    pub(crate) lambda: Vec<f64>,
}

/// One case: all arguments of the kernels of a definition.
#[derive(Clone, Debug)]
pub(crate) struct Case<S: Bodies> {
    /// Index of the case in the check.
    pub(crate) index: usize,
    /// Special property of the case.
    pub(crate) kind: Kind,
    /// Values of the parameters.
    pub(crate) arguments: Vec<Argument>,
    /// The assembled initial configuration, at which initial values are computed.
    pub(crate) start: Vec<S::Pose<f64>>,
    /// The poses at which kernels are evaluated.
    pub(crate) x: Vec<S::Pose<f64>>,
    /// The functions of time, as values with two derivatives.
    pub(crate) f: Vec<[f64; 3]>,
    /// Whether the kernels use the cosine and sine of the last function of time.
    pub(crate) turning: bool,
    /// The values of the unwrapped angles, as arguments of the kernels.
    pub(crate) counted: Vec<f64>,
    pub(crate) motions: Vec<Motion>,
    pub(crate) spec: &'static Spec,
}

impl<S: Bodies> Case<S> {
    /// Returns all cases for a definition with this number of rows. `turning` is `true` if the
    /// kernels use the cosine and sine of the last function of time. `turns` is the number of
    /// unwrapped angles.
    pub(crate) fn all(
        seed: u64,
        spec: &'static Spec,
        rows: usize,
        turning: bool,
        turns: usize,
    ) -> impl Iterator<Item = Self> {
        let kinds = std::iter::repeat_n(Kind::Ordinary, ORDINARY_CASES).chain(
            Kind::AWKWARD
                .into_iter()
                .flat_map(|k| std::iter::repeat_n(k, AWKWARD_CASES)),
        );
        let mut random = Random(seed);
        kinds.enumerate().map(move |(index, kind)| Self {
            index,
            kind,
            arguments: spec
                .parameters
                .iter()
                .map(|p| argument::<S>(p, kind, &mut random))
                .collect(),
            start: poses::<S>(spec.slots.len(), kind, &mut random),
            x: poses::<S>(spec.slots.len(), kind, &mut random),
            f: spec
                .functions()
                .map(|_| std::array::from_fn(|_| random.within(2.0)))
                .collect(),
            turning,
            counted: (0..turns).map(|_| random.within(20.0)).collect(),
            motions: (0..MOTIONS)
                .map(|_| motion::<S>(spec.slots.len(), rows, kind, &mut random))
                .collect(),
            spec,
        })
    }

    /// Returns whether kernels are also compared with finite differences. This comparison is done
    /// in every fourth ordinary case, because it is the most expensive part of a check.
    pub(crate) fn has_differences(&self) -> bool {
        self.kind == Kind::Ordinary && self.index.is_multiple_of(4)
    }

    /// Returns the case with another ordinary initial configuration. The region of coordinates
    /// grows with every attempt, because a wheel must be above a plane, and the plane may be far
    /// away.
    pub(crate) fn with_another_start(&self, attempt: u64) -> Self {
        let mut random = Random(attempt ^ ((self.index as u64) << 32));
        let reach = REACH * (1.0 + attempt as f64 / 50.0);
        Self {
            start: poses_within::<S>(self.x.len(), Kind::Ordinary, reach, &mut random),
            ..self.clone()
        }
    }

    /// Returns the case after a rigid motion of all bodies. The rigid motion changes poses, initial
    /// poses and motions.
    pub(crate) fn moved(&self) -> Self {
        let poses = |x: &[S::Pose<f64>]| x.iter().map(S::carried).collect();
        let twists = |v: &[f64]| -> Vec<f64> {
            let bodies = v.chunks(S::N_DOF);
            bodies.flat_map(S::carried_velocities).collect()
        };
        Self {
            start: poses(&self.start),
            x: poses(&self.x),
            motions: self
                .motions
                .iter()
                .map(|m| Motion {
                    v: twists(&m.v),
                    a: twists(&m.a),
                    lambda: m.lambda.clone(),
                })
                .collect(),
            ..self.clone()
        }
    }

    /// Returns the largest coordinate of poses, initial poses and parameters, or 1 if all are
    /// smaller. A relative error of ε in this coordinate changes Φ by ε times this coordinate times
    /// ‖C‖.
    pub(crate) fn size(&self) -> f64 {
        let poses = self.x.iter().chain(&self.start).flat_map(|p| {
            let ([x, y, z], angle) = S::origin(p);
            [x, y, z, angle]
        });
        let arguments = self.arguments.iter().flat_map(|a| match a {
            Argument::Pair(p) => p.to_vec(),
            Argument::Triple(p) => p.to_vec(),
            Argument::Pairs([a, b]) => vec![a[0], a[1], b[0], b[1]],
            Argument::Triples([a, b]) => [*a, *b].concat(),
            Argument::Numbers(n) => n.clone(),
            Argument::Axis(..) | Argument::Axes(_) | Argument::Absent => Vec::new(),
        });
        let functions = self.f.iter().flatten().copied();
        poses
            .chain(arguments)
            .chain(functions)
            .fold(1.0, |m, e| m.max(e.abs()))
    }
}

impl<S: Bodies> fmt::Display for Case<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  case {} ({:?})", self.index, self.kind)?;
        for (parameter, argument) in self.spec.parameters.iter().zip(&self.arguments) {
            writeln!(f, "  {} = {argument:?}", parameter.name)?;
        }
        for (name, poses) in [("start", &self.start), ("pose", &self.x)] {
            write!(f, "  {name}")?;
            for p in poses {
                write!(f, " {}", S::words(p))?;
            }
            writeln!(f)?;
        }
        write!(f, "  functions of time, with two derivatives {:?}", self.f)
    }
}

fn argument<S: Bodies>(parameter: &Parameter, kind: Kind, random: &mut Random) -> Argument {
    if parameter.optional && random.below(2) == 0 {
        return Argument::Absent;
    }
    match parameter.shape {
        Shape::Point { .. } if matches!(kind, Kind::ZeroOffsets | Kind::CoincidentPoints) => {
            S::argument([0.0; 3])
        }
        Shape::Point { .. } => S::argument(vector::<S>(2.0, random)),
        Shape::Direction { .. } if kind == Kind::RightAngles => {
            let along = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][random.below(4)];
            S::argument([along[0], along[1], 0.0])
        }
        Shape::Direction { .. } => S::argument(vector::<S>(1.0, random)),
        Shape::Axes { .. } => axes(kind, random),
        Shape::GroundPlane => {
            let mut triple = || vector::<S>(2.0, random);
            Argument::Triples([triple(), triple()])
        }
        Shape::GroundLine => Argument::Pairs([random.pair(2.0), random.pair(2.0)]),
        Shape::Numbers(units) => {
            Argument::Numbers(units.iter().map(|&u| number(u, random)).collect())
        }
        Shape::Functions(_) => Argument::Absent,
    }
}

fn number(unit: Unit, random: &mut Random) -> f64 {
    match unit {
        // The radius is smaller than the largest coordinate of poses, because some definitions
        // require that the distance of a body from a plane exceeds the radius.
        Unit::Radius => random.within(1.0).abs(),
        unit if unit.may_be_negative() => random.within(3.0),
        _ => random.within(5.0).abs(),
    }
}

/// Returns a vector with random components.
fn vector<S: Bodies>(reach: f64, random: &mut Random) -> [f64; 3] {
    let mut vector = [0.0; 3];
    vector[..S::DIM].fill_with(|| random.within(reach));
    vector
}

fn poses<S: Bodies>(n: usize, kind: Kind, random: &mut Random) -> Vec<S::Pose<f64>> {
    let reach = if kind == Kind::FarApart { 1e3 } else { REACH };
    poses_within::<S>(n, kind, reach, random)
}

fn poses_within<S: Bodies>(
    n: usize,
    kind: Kind,
    reach: f64,
    random: &mut Random,
) -> Vec<S::Pose<f64>> {
    let base = match kind {
        Kind::FarTogether => 1e3,
        _ => 0.0,
    };
    let first = S::draw(kind, base, reach, random);
    (0..n)
        .map(|slot| match kind {
            _ if slot == 0 => first,
            Kind::Coincident | Kind::CoincidentPoints => first,
            Kind::ParallelFrames => {
                S::with_orientation(&S::draw(kind, base, reach, random), &first)
            }
            _ => S::draw(kind, base, reach, random),
        })
        .collect()
}

fn motion<S: Bodies>(slots: usize, rows: usize, kind: Kind, random: &mut Random) -> Motion {
    let speed = if kind == Kind::AtRest { 0.0 } else { 2.0 };
    let mut numbers = |reach: f64| -> Vec<f64> {
        (0..S::N_DOF * slots)
            .map(|_| random.within(reach))
            .collect()
    };
    let (v, a) = (numbers(speed), numbers(5.0));
    Motion {
        v,
        a,
        lambda: (0..rows).map(|_| random.within(3.0)).collect(),
    }
}

/// The random-number generator SplitMix64 (Steele, Lea, Flood 2014). The generator is reproducible
/// on every platform and needs no dependency.
pub struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number that is uniformly distributed in ±`reach`.
    pub(crate) fn within(&mut self, reach: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1u64 << 53) as f64;
        reach * (2.0 * unit - 1.0)
    }

    pub(crate) fn pair(&mut self, reach: f64) -> [f64; 2] {
        [self.within(reach), self.within(reach)]
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() >> 33) as usize % n
    }
}
