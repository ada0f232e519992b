//! A force law of a joint coordinate acts as an applied force: `Q = law(measure, rate,
//! t)·∂measure/∂x`. The force law uses the kernels of the drive of this coordinate. Therefore every
//! coordinate of every joint can have a force law.
//!
//! A drive defines its coordinate by a row Φ(x, m) = 0, where m is the change since the start. If
//! the row is coordinate − initial coordinate − m, the gradient of the coordinate is C. If the row
//! of the joint itself contains m, the row is at most quadratic in m: Φ(x, m) = Φ(x, 0) − s₀·m −
//! ½·s₁·m². Here s = −∂Φ/∂m = s₀ + s₁·m is the component of the drive. Then m = 2Φ/(s₀ + s) with s
//! = √(s₀² + 2·s₁·Φ) and Φ at m = 0, and the gradient is C/s. For a distance, s = |d|/L.

use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{
    Constraint, ConstraintKernels, Definition, ForceElement, Plane, RecordedNumber, Space3,
};

use super::number::Smooth;
use super::{DriveForce, Law, LawError, LawState};
use crate::element::{BodySpace, DriveScalar, ForceKernels, Kinematics, PoseOf, RowsAt, TwistOf};

/// Largest number of bodies of a joint with a force law. No joint of the library has more than
/// three bodies.
const MOST_BODIES: usize = 4;
/// Largest number of velocity components of these bodies. Each body in space has six.
const MOST: usize = MOST_BODIES * 6;

/// The force law of one coordinate of a joint.
#[derive(Clone)]
pub(crate) struct LawDrive<S: BodySpace> {
    drive: Box<dyn ConstraintKernels<S>>,
    facts: &'static ForceSpec,
    law: Law,
    measured: MeasureReading,
}

/// The method that computes the joint coordinate from the row of the drive.
#[derive(Clone, Copy)]
enum MeasureReading {
    /// The joint coordinate is Φ evaluated without a motion.
    ByRow,
    /// The row of the joint contains the change of the joint coordinate since the start. The value
    /// is the initial value of the coordinate.
    Kept(f64),
    /// The joint coordinate is the unwrapped angle in space since the start. The value is the
    /// initial angle of the axes.
    Turn(f64),
}

/// Replaces the motion of a drive by a force law.
pub(crate) fn law_drive<K: Constraint<S>, S: Kinematics>(
    drive: K,
    law: Law,
) -> Result<Box<dyn ForceKernels<S>>, LawError>
where
    LawDrive<S>: ForceKernels<S>,
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
        MeasureReading::Turn(0.0)
    } else {
        MeasureReading::ByRow
    };
    Ok(Box::new(LawDrive {
        drive: drive.boxed(),
        facts: &LawFacts::<K, S>::SPEC,
        law,
        measured,
    }))
}

/// Name of the datum with the initial value of a joint coordinate, if the drive has a separate row
/// for the coordinate.
pub(crate) const MEASURE_0: &str = "measure_0";

impl<S: Kinematics> Definition<S> for LawDrive<S> {
    fn initialise(&mut self, x: &[PoseOf<S>]) {
        if let MeasureReading::Turn(start) = self.measured {
            // The unwrapped angle is computed relative to the previous start. At the first start
            // the angle is zero.
            let still = vec![S::twist(&[0.0; 6]); x.len()];
            let [cos, sin, _] = self.drive.turned(0, x, &still);
            self.drive.initialise(x);
            let angle = start + sin.atan2(cos);
            self.measured = MeasureReading::Turn(if self.law.since_start { 0.0 } else { angle });
        } else {
            self.drive.initialise(x);
            let spec = self.drive.spec();
            let mut numbers = vec![0.0; spec.n_data()];
            self.drive.data(&mut numbers);
            let mut data = spec.data.iter().rev();
            let measure = spec.common.scene_type;
            self.measured = match data.find(|d| d.name == MEASURE_0 || d.name == measure) {
                Some(datum) if datum.name == MEASURE_0 && self.law.since_start => {
                    MeasureReading::ByRow
                }
                Some(datum) if datum.name == MEASURE_0 => {
                    // If this value is zero, the row of the drive is the joint coordinate itself.
                    numbers[datum.first] = 0.0;
                    self.drive.set_data(&numbers);
                    MeasureReading::ByRow
                }
                _ if self.law.since_start => MeasureReading::Kept(0.0),
                found => MeasureReading::Kept(found.map_or(0.0, |datum| numbers[datum.first])),
            };
        }
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

/// The joint coordinate and its gradient at one configuration.
struct Along<T> {
    measure: T,
    gradient: [T; MOST],
    /// s and s₁ if the row of the joint contains the change of the coordinate.
    kept: Option<[T; 2]>,
    /// The value passed to the drive instead of a motion.
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

impl<S: Kinematics> LawDrive<S> {
    /// Returns the joint coordinate at these poses. `f` contains the time. For an angle in space,
    /// `f` also contains the values of the unwrapped angle.
    fn along<T: Smooth + DriveScalar>(&self, x: &[PoseOf<S, T>], f: &[[T; 3]]) -> Along<T> {
        let kernels = self.drive.as_ref();
        let stored = T::stored_by(kernels, |value, _| T::from(value));
        let at = |f| RowsAt {
            kernels,
            stored: &stored,
            x,
            f,
        };
        let [zero, one, two] = [0.0, 1.0, 2.0].map(T::from);
        let mut along = Along {
            measure: zero,
            gradient: [zero; MOST],
            kept: None,
            motion: [[zero; 3]; 2],
        };
        if let (MeasureReading::Turn(start), [_, angle, cos, sin, ..]) = (self.measured, f) {
            along.measure = T::from(start) + angle[0];
            along.motion = [[cos[0], zero, zero], [sin[0], zero, zero]];
        }
        let motion = along.motion;
        let here = at(&motion);
        let spec = kernels.spec();
        let mut entries = [zero; MOST];
        T::c(&here, &mut entries[..spec.c.len()]);
        if !matches!(self.measured, MeasureReading::Turn(_)) {
            let mut phi = [zero];
            T::phi(&here, &mut phi);
            along.measure = phi[0];
        }
        if let MeasureReading::Kept(initial) = self.measured {
            let (mut s_0, mut s_1) = ([zero], [zero]);
            T::component(&here, &mut s_0);
            T::component(&at(&[[one, zero, zero]]), &mut s_1);
            let phi = along.measure;
            let [s_0, s_1] = [s_0[0], s_1[0] - s_0[0]];
            let s = (s_0 * s_0 + two * s_1 * phi).sqrt();
            along.measure = T::from(initial) + two * phi / (s_0 + s);
            along.kept = Some([s, s_1]);
        }
        for (entry, value) in spec.c.iter().zip(entries) {
            along.gradient[S::N_DOF * entry.slot + entry.dof] = match along.kept {
                Some([s, _]) => value / s,
                None => value,
            };
        }
        along
    }

    /// Returns the joint coordinate, its rate and the time.
    fn inputs(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]]) -> [f64; 3] {
        let along = self.along::<f64>(x, f);
        [along.measure, along.rate::<S>(v), f[0][0]]
    }

    /// Returns the arguments and the result of the force law.
    fn drive_force(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]]) -> DriveForce {
        let inputs = self.inputs(x, v, f);
        DriveForce {
            measure: inputs[0],
            rate: inputs[1],
            force: self.law.force(inputs, self.states(f)),
        }
    }

    /// Returns the states of the law, which are the last values of `f`.
    fn states<'f, T: Copy>(&self, f: &'f [[T; 3]]) -> impl Iterator<Item = T> + 'f {
        f[f.len() - self.law.n_states()..].iter().map(|jet| jet[0])
    }

    /// Writes a value for each state of the law. `next` returns this value and the value that the
    /// law uses for the state.
    fn write_states(
        &self,
        inputs: [f64; 3],
        out: &mut [f64],
        mut next: impl FnMut(LawState, [f64; 2]) -> [f64; 2],
    ) {
        let mut all = out.iter_mut();
        let value = self.law.follow(inputs, |state, inputs| {
            let [written, used] = next(state, inputs);
            if let Some(out) = all.next() {
                *out = written;
            }
            used
        });
        if value.is_err() {
            out.fill(f64::NAN);
        }
    }

    /// Computes the entries of Q.
    fn entries<T: Smooth + DriveScalar>(
        &self,
        x: &[PoseOf<S, T>],
        v: &[TwistOf<S, T>],
        f: &[[T; 3]],
        out: &mut [T],
    ) {
        let along = self.along::<T>(x, f);
        let inputs = [along.measure, along.rate::<S>(v), f[0][0]];
        let force = self.law.force(inputs, self.states(f));
        let force = force.unwrap_or_else(|_| T::from(f64::NAN));
        for (out, g) in out.iter_mut().zip(along.gradient) {
            *out = force * g;
        }
    }
}

/// The specification of a force law on the joint coordinate of a drive.
struct LawFacts<K, S>(std::marker::PhantomData<(K, S)>);

impl<K: Constraint<S>, S: Kinematics> LawFacts<K, S> {
    const SPEC: ForceSpec = Self::spec();

    /// The specification lists all columns. The columns of C determine which of the listed columns
    /// are zero.
    const fn spec() -> ForceSpec {
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

impl<S: Kinematics> ForceElement<f64, S> for LawDrive<S> {
    fn spec(&self) -> &'static ForceSpec {
        self.facts
    }

    fn q(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        self.entries(x, v, f, out);
    }

    fn dq_dx(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        let (element, spec) = (&self.drive, self.drive.spec());
        let along = self.along::<f64>(x, f);
        let (g, rate) = (along.gradient, along.rate::<S>(v));
        let states: Vec<f64> = self.states(f).collect();
        let Ok(law) = self.law.slope([along.measure, rate, f[0][0]], &states) else {
            return out.fill(f64::NAN);
        };
        let n = S::N_DOF * spec.common.slots.len();
        let (s, turn) = along.kept.map_or((1.0, 0.0), |[s, s_1]| (s, s_1 / s));
        // The derivatives ∂rate/∂x and F·∂g/∂x. The kernels compute these derivatives for constant
        // s. The terms with `turn` add the effect of a change of s.
        let mut values = [0.0; MOST * MOST];
        let mut of_rate = [0.0; MOST];
        element.d_velocity_dx(x, v, &along.motion, &mut values);
        for (&[_, b], value) in spec.d_velocity_dx.iter().zip(values) {
            of_rate[b] = value / s;
        }
        for (out, k) in out.iter_mut().zip(0..) {
            let (a, b) = (k / n, k % n);
            let of_rate = of_rate[b] - rate * turn * g[b];
            let of_law = law.by[0] * g[b] + law.by[1] * of_rate;
            *out = g[a] * (of_law - law.value * turn * g[b]);
        }
        element.d_force_dx(x, &along.motion, &[1.0], &mut values);
        for (&[a, b], value) in spec.d_force_dx.iter().zip(values) {
            out[n * a + b] += law.value * value / s;
        }
    }

    fn dq_dv(&self, x: &[PoseOf<S>], v: &[TwistOf<S>], f: &[[f64; 3]], out: &mut [f64]) {
        let along = self.along::<f64>(x, f);
        let states: Vec<f64> = self.states(f).collect();
        let inputs = [along.measure, along.rate::<S>(v), f[0][0]];
        let law = self.law.slope(inputs, &states);
        let by_rate = law.map_or(f64::NAN, |law| law.by[1]);
        let n = S::N_DOF * self.drive.spec().common.slots.len();
        for (out, k) in out.iter_mut().zip(0..) {
            *out = by_rate * along.gradient[k / n] * along.gradient[k % n];
        }
    }
}

/// The kernels of a force law as kernels of a force in one space. A macro is necessary. A
/// downstream crate might define kernels for its own space, so a generic implementation for all
/// spaces is not possible.
macro_rules! force_kernels {
    ($space:ident) => {
        impl ForceKernels<$space> for LawDrive<$space> {
            fn recorded_q(
                &self,
                x: &[PoseOf<$space, RecordedNumber>],
                v: &[TwistOf<$space, RecordedNumber>],
                f: &[[RecordedNumber; 3]],
                out: &mut [RecordedNumber],
            ) {
                self.entries(x, v, f, out);
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

            fn n_states(&self) -> usize {
                self.law.n_states()
            }

            fn state_rates(
                &self,
                x: &[PoseOf<$space>],
                v: &[TwistOf<$space>],
                f: &[[f64; 3]],
                out: &mut [f64],
            ) {
                let mut states = self.states(f);
                self.write_states(self.inputs(x, v, f), out, |state, inputs| {
                    let own = states.next().unwrap_or(f64::NAN);
                    [state.rate(inputs, own), own]
                });
            }

            fn first_states(
                &self,
                x: &[PoseOf<$space>],
                v: &[TwistOf<$space>],
                f: &[[f64; 3]],
                out: &mut [f64],
            ) {
                self.write_states(self.inputs(x, v, f), out, |state, inputs| {
                    [state.start(inputs); 2]
                });
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
                Some(self.drive_force(x, v, f))
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

/// Returns all pairs of `n` columns, row by row.
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

/// Returns the pattern of a full block of `n` columns.
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
