//! A law on a measure as an applied force: `Q = law(measure, rate, t)·∂measure/∂x`, from the
//! kernels of the drive of that measure, so that any measure of any joint has it.
//!
//! A drive states its measure by a row Φ(x, m) = 0, m the change since the start. Where the row is
//! measure − measure₀ − m, the gradient of the measure is C. Where the row of the joint takes m, it
//! is at most quadratic in it, Φ(x, m) = Φ(x, 0) − s₀·m − ½·s₁·m² with s = −∂Φ/∂m = s₀ + s₁·m, the
//! component of the drive; then m = 2Φ/(s₀ + s), s = √(s₀² + 2·s₁·Φ), Φ at m = 0, and the gradient
//! is C/s. For a distance, s = |d|/L.

use joints::plane::N_DOF;
use joints::spec::{ConstraintSpec, ForceSpec};
use joints::{
    Argument, Constraint, Definition, Derivatives, Element, ForceElement, Pose, Recorded, Twist,
};

use super::number::Smooth;
use super::{DriveForce, Law, LawError};
use crate::element::ForceKernels;

/// Largest number of bodies of a joint with a law; no joint of the library has more than three.
const MOST_BODIES: usize = 4;
const MOST: usize = MOST_BODIES * N_DOF;

/// The law of one measure of the joint of `K`.
#[derive(Clone)]
pub(crate) struct LawDrive<K> {
    drive: K,
    law: Law,
    /// Entries of C that depend on parameters only.
    constant: [f64; MOST],
    /// Value of the measure at the start, if the row of the joint takes its change; else the row
    /// of the drive tells the measure itself.
    kept: Option<f64>,
}

/// Builds the law of a measure from the arguments of its joint.
pub(crate) fn build_law<K: Constraint>(
    arguments: &[Argument],
    law: Law,
) -> Result<Box<dyn ForceKernels>, LawError> {
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
    Ok(Box::new(LawDrive {
        drive: K::from_arguments(arguments)?,
        law,
        constant: [0.0; MOST],
        kept: None,
    }))
}

/// Name of the datum with the initial value of a measure that has a row of its own.
const OF_ROW: &str = "measure_0";

impl<K: Constraint> Definition for LawDrive<K> {
    fn initialise(&mut self, x: &[Pose]) {
        self.drive.initialise(x);
        let mut numbers = vec![0.0; K::SPEC.n_data()];
        self.drive.data(&mut numbers);
        let mut data = K::SPEC.data.iter().rev();
        let measure = K::SPEC.common.scene_type;
        match data.find(|d| d.name == OF_ROW || d.name == measure) {
            Some(datum) if datum.name == OF_ROW => {
                // Then its row is the measure itself.
                numbers[datum.first] = 0.0;
                self.drive.set_data(&numbers);
                self.kept = None;
            }
            found => self.kept = Some(found.map_or(0.0, |datum| numbers[datum.first])),
        }
        let element: &dyn Element = self.drive.element();
        element.c_constant(&mut self.constant[..K::SPEC.c.len()]);
    }

    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        self.drive.requirement(k, x)
    }

    fn points(&self) -> Vec<[f64; 2]> {
        self.drive.points()
    }
}

/// The measure and its gradient at one configuration.
struct Along<T> {
    measure: T,
    gradient: [T; MOST],
    /// s and s₁ if the row of the joint takes the change of the measure.
    kept: Option<[T; 2]>,
}

impl<T: Smooth> Along<T> {
    fn rate(&self, v: &[Twist<T>]) -> T {
        let of_body = |(g, v): (&[T], &Twist<T>)| g[0] * v.x + g[1] * v.y + g[2] * v.omega;
        let bodies = self.gradient.chunks_exact(N_DOF).zip(v);
        bodies.map(of_body).fold(T::from(0.0), |sum, x| sum + x)
    }
}

impl<K: Constraint> LawDrive<K> {
    fn along<T: Smooth>(&self, x: &[Pose<T>]) -> Along<T> {
        let element: &dyn Element<T> = self.drive.element();
        let [zero, one, two] = [0.0, 1.0, 2.0].map(T::from);
        let start = [[zero; 3]];
        let mut phi = [zero];
        element.phi(x, &start, &mut phi);
        let mut entries = self.constant.map(T::from);
        element.c(x, &start, &mut entries[..K::SPEC.c.len()]);
        let mut along = Along {
            measure: phi[0],
            gradient: [zero; MOST],
            kept: None,
        };
        if let Some(initial) = self.kept {
            let (mut s_0, mut s_1) = ([zero], [zero]);
            element.component(x, &start, &mut s_0);
            element.component(x, &[[one, zero, zero]], &mut s_1);
            let [s_0, s_1] = [s_0[0], s_1[0] - s_0[0]];
            let s = (s_0 * s_0 + two * s_1 * phi[0]).sqrt();
            along.measure = T::from(initial) + two * phi[0] / (s_0 + s);
            along.kept = Some([s, s_1]);
        }
        for (entry, value) in K::SPEC.c.iter().zip(entries) {
            along.gradient[N_DOF * entry.slot + entry.dof] = match along.kept {
                Some([s, _]) => value / s,
                None => value,
            };
        }
        along
    }

    /// All columns: which of them vanish is left to the columns of C.
    const SPEC: ForceSpec = {
        let spec: &ConstraintSpec = &K::SPEC;
        let n = N_DOF * spec.common.slots.len();
        ForceSpec {
            common: spec.common,
            q: COLUMNS.split_at(if n < MOST { n } else { MOST }).0,
            dq_dx: full(n),
            dq_dv: full(n),
            dissipative: true,
            rheonomic: true,
        }
    };
}

impl<T: Smooth, K: Constraint> ForceElement<T> for LawDrive<K> {
    fn spec(&self) -> &'static ForceSpec {
        &Self::SPEC
    }

    fn q(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        let along = self.along(x);
        let force = self.law.evaluate([along.measure, along.rate(v), f[0][0]]);
        let force = force.unwrap_or_else(|_| T::from(f64::NAN));
        for (out, g) in out.iter_mut().zip(along.gradient) {
            *out = force * g;
        }
    }

    fn dq_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        let element: &dyn Derivatives<T> = self.drive.derivatives();
        let [zero, one, nan] = [0.0, 1.0, f64::NAN].map(T::from);
        let along = self.along(x);
        let (g, rate) = (along.gradient, along.rate(v));
        let Ok(law) = self.law.slope([along.measure, rate, f[0][0]]) else {
            return out.fill(nan);
        };
        let n = N_DOF * K::SPEC.common.slots.len();
        let (s, turn) = along.kept.map_or((one, zero), |[s, s_1]| (s, s_1 / s));
        // ∂rate/∂x and F·∂g/∂x, both without and with the change of s.
        let (at_rest, mut values) = ([[zero; 3]], [zero; MOST * MOST]);
        let mut of_rate = [zero; MOST];
        element.d_velocity_dx(x, v, &at_rest, &mut values);
        for (&[_, b], value) in K::SPEC.d_velocity_dx.iter().zip(values) {
            of_rate[b] = value / s;
        }
        for (out, k) in out.iter_mut().zip(0..) {
            let (a, b) = (k / n, k % n);
            let of_rate = of_rate[b] - rate * turn * g[b];
            let of_law = law.by[0] * g[b] + law.by[1] * of_rate;
            *out = g[a] * (of_law - law.value * turn * g[b]);
        }
        element.d_force_dx(x, &at_rest, &[one], &mut values);
        for (&[a, b], value) in K::SPEC.d_force_dx.iter().zip(values) {
            out[n * a + b] = out[n * a + b] + law.value * value / s;
        }
    }

    fn dq_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        let along = self.along(x);
        let law = self.law.slope([along.measure, along.rate(v), f[0][0]]);
        let by_rate = law.map_or_else(|_| T::from(f64::NAN), |law| law.by[1]);
        let n = N_DOF * K::SPEC.common.slots.len();
        for (out, k) in out.iter_mut().zip(0..) {
            *out = by_rate * along.gradient[k / n] * along.gradient[k % n];
        }
    }
}

impl<K: Constraint> ForceKernels for LawDrive<K> {
    fn recorded(&self) -> &dyn ForceElement<Recorded> {
        self
    }

    fn boxed(&self) -> Box<dyn ForceKernels> {
        Box::new(self.clone())
    }

    fn is_law(&self) -> bool {
        true
    }

    fn drive(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]]) -> Option<DriveForce> {
        let along = self.along(x);
        let (measure, rate) = (along.measure, along.rate(v));
        Some(DriveForce {
            measure,
            rate,
            force: self.law.value(measure, rate, f[0][0]),
        })
    }
}

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

/// The pattern of a full block of `n` columns.
const fn full(n: usize) -> &'static [[usize; 2]] {
    match n {
        3 => &PAIRS_3,
        6 => &PAIRS_6,
        9 => &PAIRS_9,
        _ => &PAIRS_12,
    }
}
