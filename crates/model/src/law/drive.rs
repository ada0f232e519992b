//! A law on a measure as an applied force: `Q = law(measure, rate, t)·∂measure/∂x`, from the
//! kernels of the drive of that measure, so that any measure of any joint has it.
//!
//! A drive states its measure by a row Φ(x, m) = 0, m the change since the start. Where the row is
//! measure − measure₀ − m, the gradient of the measure is C. Where the row of the joint takes m, it
//! is at most quadratic in it, Φ(x, m) = Φ(x, 0) − s₀·m − ½·s₁·m² with s = −∂Φ/∂m = s₀ + s₁·m, the
//! component of the drive; then m = 2Φ/(s₀ + s), s = √(s₀² + 2·s₁·Φ), Φ at m = 0, and the gradient
//! is C/s. For a distance, s = |d|/L.

use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{Constraint, Definition, Derivatives, Element, ForceElement, Plane, Recorded, Space3};

use super::number::Smooth;
use super::{DriveForce, Law, LawError};
use crate::element::{ForceKernels, Kinematics, PoseOf, TwistOf};

/// Largest number of bodies of a joint with a law; no joint of the library has more than three.
const MOST_BODIES: usize = 4;
/// Largest number of velocities of these bodies: six in space.
const MOST: usize = MOST_BODIES * 6;

/// The law of one measure of the joint of `K`.
#[derive(Clone)]
pub(crate) struct LawDrive<K> {
    drive: K,
    law: Law,
    /// Entries of C that depend on parameters only.
    constant: [f64; MOST],
    measured: Measured,
}

/// How the row of the drive tells its measure.
#[derive(Clone, Copy)]
enum Measured {
    /// It is Φ itself, at no motion.
    ByRow,
    /// The row of the joint takes the change of the measure since the start, whose value this is.
    Kept(f64),
    /// It is a counted angle in space, since the start, where this was the angle of the axes.
    Turn(f64),
}

/// Puts a law in the place of the motion of a drive.
pub(crate) fn law_drive<K: Constraint<S>, S: Kinematics>(
    drive: K,
    law: Law,
) -> Result<Box<dyn ForceKernels<S>>, LawError>
where
    LawDrive<K>: ForceKernels<S>,
{
    let spec = &K::SPEC;
    let (rows, slots) = (spec.rows.len(), spec.common.slots.len());
    if rows != 1 || slots > MOST_BODIES {
        return Err(LawError::Rows {
            definition: spec.common.name,
            rows,
            slots,
            most: MOST_BODIES,
        });
    }
    let measured = if spec.turning {
        Measured::Turn(0.0)
    } else {
        Measured::ByRow
    };
    Ok(Box::new(LawDrive {
        drive,
        law,
        constant: [0.0; MOST],
        measured,
    }))
}

/// Name of the datum with the initial value of a measure that has a row of its own.
const OF_ROW: &str = "measure_0";

impl<K: Constraint<S>, S: Kinematics> Definition<S> for LawDrive<K> {
    fn initialise(&mut self, x: &[PoseOf<S>]) {
        if let Measured::Turn(start) = self.measured {
            // Since the start that was known before, which was none at first.
            let still = vec![S::twist(&[0.0; 6]); x.len()];
            let [cos, sin, _] = self.drive.turned(0, x, &still);
            self.drive.initialise(x);
            let angle = start + sin.atan2(cos);
            self.measured = Measured::Turn(if self.law.since_start { 0.0 } else { angle });
        } else {
            self.drive.initialise(x);
            let mut numbers = vec![0.0; K::SPEC.n_data()];
            self.drive.data(&mut numbers);
            let mut data = K::SPEC.data.iter().rev();
            let measure = K::SPEC.common.scene_type;
            self.measured = match data.find(|d| d.name == OF_ROW || d.name == measure) {
                Some(datum) if datum.name == OF_ROW && self.law.since_start => Measured::ByRow,
                Some(datum) if datum.name == OF_ROW => {
                    // Then its row is the measure itself.
                    numbers[datum.first] = 0.0;
                    self.drive.set_data(&numbers);
                    Measured::ByRow
                }
                _ if self.law.since_start => Measured::Kept(0.0),
                found => Measured::Kept(found.map_or(0.0, |datum| numbers[datum.first])),
            };
        }
        let element: &dyn Element<f64, S> = self.drive.element();
        element.c_constant(&mut self.constant[..K::SPEC.c.len()]);
    }

    fn requirement(&self, k: usize, x: &[PoseOf<S>]) -> bool {
        self.drive.requirement(k, x)
    }

    fn turned(&self, k: usize, x: &[PoseOf<S>], v: &[TwistOf<S>]) -> [f64; 3] {
        self.drive.turned(k, x, v)
    }

    fn points(&self) -> Vec<S::Vector<f64>> {
        self.drive.points()
    }
}

/// The measure and its gradient at one configuration.
struct Along<T> {
    measure: T,
    gradient: [T; MOST],
    /// s and s₁ if the row of the joint takes the change of the measure.
    kept: Option<[T; 2]>,
    /// What the drive is given in place of a motion.
    motion: [[T; 3]; 2],
}

impl<T: Smooth> Along<T> {
    fn rate<S: Kinematics>(&self, v: &[TwistOf<S, T>]) -> T {
        let of_body = |(g, v): (&[T], &TwistOf<S, T>)| {
            let products = g.iter().zip(S::velocities(v)).map(|(g, v)| *g * v);
            products.reduce(|sum, x| sum + x).unwrap_or(T::from(0.0))
        };
        let bodies = self.gradient.chunks_exact(S::N_DOF).zip(v);
        bodies.map(of_body).fold(T::from(0.0), |sum, x| sum + x)
    }
}

impl<K> LawDrive<K> {
    /// The measure at these poses. `f` is the time, and for an angle in space what is given of it.
    fn along<T: Smooth, S: Kinematics>(&self, x: &[PoseOf<S, T>], f: &[[T; 3]]) -> Along<T>
    where
        K: Constraint<S>,
    {
        let element: &dyn Element<T, S> = self.drive.element();
        let [zero, one, two] = [0.0, 1.0, 2.0].map(T::from);
        let mut along = Along {
            measure: zero,
            gradient: [zero; MOST],
            kept: None,
            motion: [[zero; 3]; 2],
        };
        if let (Measured::Turn(start), [_, angle, cos, sin, ..]) = (self.measured, f) {
            along.measure = T::from(start) + angle[0];
            along.motion = [[cos[0], zero, zero], [sin[0], zero, zero]];
        }
        let mut entries = self.constant.map(T::from);
        element.c(x, &along.motion, &mut entries[..K::SPEC.c.len()]);
        if !matches!(self.measured, Measured::Turn(_)) {
            let mut phi = [zero];
            element.phi(x, &along.motion, &mut phi);
            along.measure = phi[0];
        }
        if let Measured::Kept(initial) = self.measured {
            let (mut s_0, mut s_1) = ([zero], [zero]);
            element.component(x, &along.motion, &mut s_0);
            element.component(x, &[[one, zero, zero]], &mut s_1);
            let phi = along.measure;
            let [s_0, s_1] = [s_0[0], s_1[0] - s_0[0]];
            let s = (s_0 * s_0 + two * s_1 * phi).sqrt();
            along.measure = T::from(initial) + two * phi / (s_0 + s);
            along.kept = Some([s, s_1]);
        }
        for (entry, value) in K::SPEC.c.iter().zip(entries) {
            along.gradient[S::N_DOF * entry.slot + entry.dof] = match along.kept {
                Some([s, _]) => value / s,
                None => value,
            };
        }
        along
    }

    fn force<S: Kinematics>(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]]) -> DriveForce
    where
        K: Constraint<S>,
    {
        let along = self.along::<f64, S>(x, f);
        let (measure, rate) = (along.measure, along.rate::<S>(v));
        DriveForce {
            measure,
            rate,
            force: self.law.value(measure, rate, f[0][0]),
        }
    }

    /// All columns: which of them vanish is left to the columns of C.
    const fn spec<S: Kinematics>() -> ForceSpec
    where
        K: Constraint<S>,
    {
        let spec: &ConstraintSpec = &K::SPEC;
        let n = S::N_DOF * spec.common.slots.len();
        ForceSpec {
            common: spec.common,
            q: COLUMNS.split_at(if n < MOST { n } else { MOST }).0,
            dq_dx: full(n),
            dq_dv: full(n),
            dissipative: true,
            turns: spec.turning as usize,
            rheonomic: true,
        }
    }
}

/// The facts of a law in a space.
struct Facts<K, S>(std::marker::PhantomData<(K, S)>);

impl<K: Constraint<S>, S: Kinematics> Facts<K, S> {
    const SPEC: ForceSpec = LawDrive::<K>::spec::<S>();
}

impl<T: Smooth, K: Constraint<S>, S: Kinematics> ForceElement<T, S> for LawDrive<K> {
    fn spec(&self) -> &'static ForceSpec {
        &Facts::<K, S>::SPEC
    }

    fn q(&self, x: &[PoseOf<S, T>], v: &[TwistOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let along = self.along::<T, S>(x, f);
        let force = self.law.force([along.measure, along.rate::<S>(v), f[0][0]]);
        let force = force.unwrap_or_else(|_| T::from(f64::NAN));
        for (out, g) in out.iter_mut().zip(along.gradient) {
            *out = force * g;
        }
    }

    fn dq_dx(&self, x: &[PoseOf<S, T>], v: &[TwistOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let element: &dyn Derivatives<T, S> = self.drive.derivatives();
        let [zero, one, nan] = [0.0, 1.0, f64::NAN].map(T::from);
        let along = self.along::<T, S>(x, f);
        let (g, rate) = (along.gradient, along.rate::<S>(v));
        let Ok(law) = self.law.slope([along.measure, rate, f[0][0]]) else {
            return out.fill(nan);
        };
        let n = S::N_DOF * K::SPEC.common.slots.len();
        let (s, turn) = along.kept.map_or((one, zero), |[s, s_1]| (s, s_1 / s));
        // ∂rate/∂x and F·∂g/∂x, both without and with the change of s.
        let mut values = [zero; MOST * MOST];
        let mut of_rate = [zero; MOST];
        element.d_velocity_dx(x, v, &along.motion, &mut values);
        for (&[_, b], value) in K::SPEC.d_velocity_dx.iter().zip(values) {
            of_rate[b] = value / s;
        }
        for (out, k) in out.iter_mut().zip(0..) {
            let (a, b) = (k / n, k % n);
            let of_rate = of_rate[b] - rate * turn * g[b];
            let of_law = law.by[0] * g[b] + law.by[1] * of_rate;
            *out = g[a] * (of_law - law.value * turn * g[b]);
        }
        element.d_force_dx(x, &along.motion, &[one], &mut values);
        for (&[a, b], value) in K::SPEC.d_force_dx.iter().zip(values) {
            out[n * a + b] = out[n * a + b] + law.value * value / s;
        }
    }

    fn dq_dv(&self, x: &[PoseOf<S, T>], v: &[TwistOf<S, T>], f: &[[T; 3]], out: &mut [T]) {
        let along = self.along::<T, S>(x, f);
        let law = self.law.slope([along.measure, along.rate::<S>(v), f[0][0]]);
        let by_rate = law.map_or_else(|_| T::from(f64::NAN), |law| law.by[1]);
        let n = S::N_DOF * K::SPEC.common.slots.len();
        for (out, k) in out.iter_mut().zip(0..) {
            *out = by_rate * along.gradient[k / n] * along.gradient[k % n];
        }
    }
}

/// The kernels of a law as those of a force of a space. A downstream crate might make kernels of
/// its own space of a law, so this cannot be said of all spaces at once.
macro_rules! force_kernels {
    ($space:ident) => {
        impl<K: Constraint<$space>> ForceKernels<$space> for LawDrive<K> {
            fn recorded(&self) -> &dyn ForceElement<Recorded, $space> {
                self
            }

            fn boxed(&self) -> Box<dyn ForceKernels<$space>> {
                Box::new(self.clone())
            }

            fn is_law(&self) -> bool {
                true
            }

            fn is_called(&self) -> bool {
                self.law.is_called()
            }

            fn with_law(&self, law: &Law) -> Option<Box<dyn ForceKernels<$space>>> {
                let law = Law {
                    since_start: self.law.since_start,
                    ..law.clone()
                };
                Some(Box::new(Self {
                    law,
                    ..self.clone()
                }))
            }

            fn drive(
                &self,
                x: &[PoseOf<$space>],
                v: &[TwistOf<$space>],
                f: &[[f64; 3]],
            ) -> Option<DriveForce> {
                Some(self.force::<$space>(x, v, f))
            }
        }
    };
}

force_kernels!(Plane);
force_kernels!(Space3);

/// The columns of a block.
static COLUMNS: [usize; MOST] = {
    let mut columns = [0; MOST];
    let mut k = 0;
    while k < MOST {
        columns[k] = k;
        k += 1;
    }
    columns
};

/// All pairs of `n` columns, row by row.
const fn pairs<const M: usize>(n: usize) -> [[usize; 2]; M] {
    let mut pairs = [[0; 2]; M];
    let mut k = 0;
    while k < M {
        pairs[k] = [k / n, k % n];
        k += 1;
    }
    pairs
}

static PAIRS_3: [[usize; 2]; 9] = pairs(3);
static PAIRS_6: [[usize; 2]; 36] = pairs(6);
static PAIRS_9: [[usize; 2]; 81] = pairs(9);
static PAIRS_12: [[usize; 2]; 144] = pairs(12);
static PAIRS_18: [[usize; 2]; 324] = pairs(18);
static PAIRS_24: [[usize; 2]; 576] = pairs(24);

/// The pattern of a full block of `n` columns.
pub(crate) const fn full(n: usize) -> &'static [[usize; 2]] {
    match n {
        3 => &PAIRS_3,
        6 => &PAIRS_6,
        9 => &PAIRS_9,
        12 => &PAIRS_12,
        18 => &PAIRS_18,
        _ => &PAIRS_24,
    }
}
