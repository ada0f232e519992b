//! Checks whether generated code belongs to a mechanism and whether a run may use it. The check
//! ignores names. Sizes, rows and break times must be equal, and values must agree at the start of
//! the motion and near the start.

use std::sync::Arc;

use linalg::GRADED_MASSES;
use model::words::{estimate, listed, rough};
use model::{Mechanism, RecordedEquations, SpaceKind, System};

use super::inputs::{CodeInput, CodeInputs};
use super::{SceneCode, SharedCode};
use crate::error::MotionFault;
use crate::limits::{CODE_STATES, DISTANCE, LEAVE, SAME_VALUES, SPEED};
use crate::motion::KeptRowMotion;
use crate::options::{Method, MotionOptions, Stabilisation};
use crate::prepare::PreparedMechanism;

/// Reason why code does not belong to a mechanism.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CodeMismatch {
    /// The code was generated for a mechanism of another size.
    #[error("the code `{name}` has {found} {what}, the mechanism {expected}")]
    Size {
        /// Name of the code.
        name: String,
        /// The size that differs.
        what: &'static str,
        /// Value in the code.
        found: usize,
        /// Value in the mechanism.
        expected: usize,
    },
    /// The code was generated for other independent rows.
    #[error(
        "the code `{name}` was generated for the independent {level} rows {}, this run uses {}",
        from_one(found),
        from_one(expected)
    )]
    Rows {
        /// Name of the code.
        name: String,
        /// "position" or "velocity".
        level: &'static str,
        /// Rows of the code, from 0.
        found: Vec<usize>,
        /// Rows of the run, from 0.
        expected: Vec<usize>,
    },
    /// The break times of the code differ from the break times of the mechanism. At a break time, a
    /// derivative of a function of time jumps.
    #[error("the code `{name}` has break times at {found:?} s, the mechanism at {expected:?} s")]
    BreakTimes {
        /// Name of the code.
        name: String,
        /// Break times of the functions of time in the code (s).
        found: Vec<f64>,
        /// Break times of the functions of time in the mechanism (s).
        expected: Vec<f64>,
    },
    /// A value differs.
    #[error(
        "at t = {time} s the code `{name}` gives {what}[{index}] = {found:.9e}, the mechanism {expected:.9e}"
    )]
    Value {
        /// Name of the code.
        name: String,
        /// The function whose value differs.
        what: &'static str,
        /// Component, from 0.
        index: usize,
        /// Time (s).
        time: f64,
        /// Value of the code.
        found: f64,
        /// Value of the mechanism.
        expected: f64,
    },
    /// The health of the code is too low at the start.
    #[error(
        "the code `{name}` has a health of {health:.3} at the start, need {LEAVE}: it was generated for other configurations"
    )]
    Unhealthy {
        /// Name of the code.
        name: String,
        /// Health of the code.
        health: f64,
    },
    /// The code takes parameters of a mechanism as inputs, but this mechanism has other equations.
    #[error(
        "the code `{name}` was generated for a mechanism with other equations (joints, forces, functions of time or bodies with products of inertia differ), or by another version; generate it again"
    )]
    Shape {
        /// Name of the code.
        name: String,
    },
    /// Two parameters that share one input of the code have different values in the mechanism.
    #[error(
        "the code `{name}` uses one number for {input}, but the mechanism has both {:.9e} and {:.9e}; generate it again with a key in `--inputs` that distinguishes them",
        values[0], values[1]
    )]
    Parts {
        /// Name of the code.
        name: String,
        /// Name of the input.
        input: String,
        /// Two of the values that the input has in the mechanism.
        values: [f64; 2],
    },
    /// A mass or moment of inertia that is an input is zero in the mechanism, but was not zero when
    /// the code was generated. The order of elimination depends on whether the value is zero. The
    /// mass metric defines the smallest position correction, and it does not exist without mass.
    #[error(
        "the code `{name}` was generated for a positive {input}, but it is 0 in the mechanism; generate the code again"
    )]
    Massless {
        /// Name of the code.
        name: String,
        /// Name of the input.
        input: String,
    },
    /// The number of inputs of the code differs from the number of its input names.
    #[error("the code `{name}` lists {found} inputs but does not accept them")]
    Inputs {
        /// Name of the code.
        name: String,
        /// Number of input names.
        found: usize,
    },
    /// The equations of the mechanism have no solution at this state.
    #[error(transparent)]
    MotionFault(#[from] MotionFault),
}

fn from_one(rows: &[usize]) -> String {
    let rows: Vec<String> = rows.iter().map(|i| (i + 1).to_string()).collect();
    listed(&rows)
}

/// Reason why a run does not use generated code.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoCode {
    /// The mechanism has no generated code.
    #[error("not provided")]
    None,
    /// The method needs more than the accelerations, for example their derivatives.
    #[error("the method {0} needs more than accelerations")]
    Method(&'static str),
    /// The run does not project states onto the constraints.
    #[error("code needs projection as stabilisation, found {0}")]
    Stabilisation(&'static str),
    /// A force calls an external function, or has a law with states.
    #[error(
        "a force calls a function or has a law with a state, which generated code does not contain"
    )]
    Called,
    /// A joint has an armature, so the mass matrix depends on the configuration.
    #[error("a joint has an armature, which generated code does not support")]
    Armature,
    /// Rows may be redundant only within a stated tolerance, and their constraint violation is a
    /// result of the run.
    #[error(
        "rows are redundant within the stated tolerance, and generated code does not compute their violation"
    )]
    Misfits,
    /// Masses differ so much that solutions have to be refined, which generated code does not do.
    #[error(
        "masses and inertias differ by a factor of {spread}; above {GRADED_MASSES:.0e} solutions are refined, which generated code does not do", spread = rough(*spread))]
    Refinement {
        /// The largest mass divided by the smallest.
        spread: f64,
    },
    /// The size of the mechanism is so different from one metre that solutions have to be refined.
    #[error(
        "solutions of a mechanism of {size} are refined, which generated code does not do", size = estimate(*size, "m"))]
    Size {
        /// Size of the mechanism (m).
        size: f64,
    },
}

impl CodeInputs {
    /// Returns the values of the inputs for a mechanism, in the order of the inputs. `code` is the
    /// name of the code in error messages.
    ///
    /// # Errors
    /// - [`CodeMismatch::Shape`]: the mechanism and the code have different equations.
    /// - [`CodeMismatch::Parts`]: parameters that share one input of the code have different values
    ///   in the mechanism.
    /// - [`CodeMismatch::Massless`]: the code was generated for a positive mass that is zero in the
    ///   mechanism.
    pub fn of(&self, code: &str, mechanism: &Mechanism) -> Result<Vec<f64>, CodeMismatch> {
        let shape = || CodeMismatch::Shape {
            name: code.to_owned(),
        };
        let is_recorded = matches!(mechanism.space(), SpaceKind::Plane | SpaceKind::Space3);
        if !is_recorded || mechanism.layout().turns > 0 {
            return Err(shape());
        }
        let recording = RecordedEquations::of(mechanism);
        if recording.shape() != self.shape {
            return Err(shape());
        }
        let value = |input: &CodeInput| {
            let mut all = input.places.iter().map(|&place| recording.number(place));
            let first = all.next().flatten().ok_or_else(shape)?;
            for other in all {
                let other = other.ok_or_else(shape)?;
                let size = f64::max(first.abs(), other.abs());
                if (first - other).abs() > SAME_VALUES * size {
                    return Err(CodeMismatch::Parts {
                        name: code.to_owned(),
                        input: input.name.to_string(),
                        values: [first, other],
                    });
                }
            }
            let mut masses = recording.beside.mass.iter();
            let is_lost = first == 0.0 && input.described != 0.0;
            if is_lost && masses.any(|mass| input.places.contains(&mass.place())) {
                return Err(CodeMismatch::Massless {
                    name: code.to_owned(),
                    input: input.name.to_string(),
                });
            }
            Ok(first)
        };
        self.list.iter().map(value).collect()
    }
}

/// The states at which values are compared.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    /// At the start.
    Start,
    /// States at the start, near the start, and between break times.
    ManyStates,
}

/// Returns the code with the input values of a mechanism, if the code has inputs.
fn for_mechanism(
    code: Arc<SharedCode>,
    mechanism: &Mechanism,
) -> Result<Arc<SharedCode>, CodeMismatch> {
    let name = &code.spec().name;
    let Some(inputs) = code.inputs() else {
        return Ok(code);
    };
    let values = inputs.of(name, mechanism)?;
    let own = code.with_inputs(&values);
    own.ok_or_else(|| CodeMismatch::Inputs {
        name: name.to_string(),
        found: values.len(),
    })
}

impl PreparedMechanism {
    /// Adds code generated for this mechanism, or for a mechanism that differs only in the inputs
    /// of the code ([`SceneCode::inputs`]). Runs then use the code if possible. If the code has
    /// inputs and the user chose no rows, the run uses the independent rows of the code
    /// ([`PreparedMechanism::on_rows`]), because the automatic choice of rows may depend on the
    /// values of the inputs.
    ///
    /// # Errors
    /// Returns a [`CodeMismatch`] if the code belongs to another mechanism or to other rows.
    pub fn with_code(self, code: Arc<SharedCode>) -> Result<Self, CodeMismatch> {
        self.with_code_compared(code, At::ManyStates)
    }

    /// Returns the same mechanism without generated code.
    #[must_use]
    pub fn without_code(self) -> Self {
        Self { code: None, ..self }
    }

    /// Works like [`PreparedMechanism::with_code`], for code that has already passed this check
    /// with a mechanism of the same constraints ([`Mechanism::has_constraints_of`]). Values are
    /// compared only at the start.
    ///
    /// # Errors
    /// Returns the same errors as [`PreparedMechanism::with_code`].
    pub fn with_known_code(self, code: Arc<SharedCode>) -> Result<Self, CodeMismatch> {
        self.with_code_compared(code, At::Start)
    }

    fn with_code_compared(self, code: Arc<SharedCode>, at: At) -> Result<Self, CodeMismatch> {
        let code = for_mechanism(code, &self.mechanism)?;
        let spec = code.spec();
        let moved = code
            .inputs()
            .and_then(|_| self.on_rows(&spec.kept, &spec.position_kept));
        let own = moved.unwrap_or(self);
        check_spec(&own, &*code)?;
        check_values(&own, &*code, at)?;
        Ok(Self {
            code: Some(code),
            ..own
        })
    }

    /// Returns the code that a run with these options uses, or the reason why the run uses no code.
    ///
    /// # Errors
    /// [`NoCode`]
    pub fn code_for(&self, options: &MotionOptions) -> Result<&Arc<SharedCode>, NoCode> {
        let code = self.code.as_ref().ok_or(NoCode::None)?;
        match options.method {
            Method::Auto | Method::Dopri5 | Method::Tsit5 | Method::Dop853 => {}
            Method::Radau5 => return Err(NoCode::Method(options.method.name())),
        }
        match options.stabilisation {
            Stabilisation::Projection => {}
            other => return Err(NoCode::Stabilisation(other.name())),
        }
        if self
            .mechanism
            .applied_forces()
            .without_derivatives()
            .next()
            .is_some()
        {
            return Err(NoCode::Called);
        }
        if self.mechanism.has_armatures() {
            return Err(NoCode::Armature);
        }
        if self.may_miss {
            return Err(NoCode::Misfits);
        }
        let (spread, size) = (self.mass_spread(), self.assembly.size);
        match (spread >= GRADED_MASSES, self.is_far()) {
            (true, _) => Err(NoCode::Refinement { spread }),
            (false, true) => Err(NoCode::Size { size }),
            (false, false) => Ok(code),
        }
    }
}

fn check_spec(prepared: &PreparedMechanism, code: &dyn SceneCode) -> Result<(), CodeMismatch> {
    let (spec, layout) = (code.spec(), prepared.mechanism.layout());
    let name = || spec.name.to_string();
    let sizes = [
        ("coordinates", spec.n_q, layout.n_q),
        ("velocities", spec.n_v, layout.n_v),
        ("holonomic rows", spec.m, layout.m),
        ("nonholonomic rows", spec.h, layout.h),
    ];
    for (what, found, expected) in sizes {
        if found != expected {
            return Err(CodeMismatch::Size {
                name: name(),
                what,
                found,
                expected,
            });
        }
    }
    let rows = [
        ("velocity", &spec.kept, &prepared.decision.kept),
        (
            "position",
            &spec.position_kept,
            &prepared.position_decision.kept,
        ),
    ];
    for (level, found, expected) in rows {
        if found.as_ref() != expected.as_slice() {
            return Err(CodeMismatch::Rows {
                name: name(),
                level,
                found: found.to_vec(),
                expected: expected.clone(),
            });
        }
    }
    if *spec.break_times == *layout.break_times {
        Ok(())
    } else {
        Err(CodeMismatch::BreakTimes {
            name: name(),
            found: spec.break_times.to_vec(),
            expected: layout.break_times.clone(),
        })
    }
}

/// Values from the code and from the interpreter at one instant.
struct Comparison<'a> {
    name: &'a str,
    time: f64,
    what: &'static str,
    found: &'a [f64],
    expected: &'a [f64],
}

impl Comparison<'_> {
    /// Checks that each component i differs by at most `SAME_VALUES·size(i)`.
    fn check(&self, size: impl Fn(usize) -> f64) -> Result<(), CodeMismatch> {
        let differs = |i: &usize| {
            let by = (self.found[*i] - self.expected[*i]).abs();
            by.is_nan() || by > SAME_VALUES * size(*i)
        };
        match (0..self.expected.len()).find(differs) {
            None => Ok(()),
            Some(index) => Err(CodeMismatch::Value {
                name: self.name.to_owned(),
                what: self.what,
                index,
                time: self.time,
                found: self.found[index],
                expected: self.expected[index],
            }),
        }
    }
}

/// Returns the start, and times between the break times.
fn times(mechanism: &Mechanism) -> Vec<f64> {
    let (start, breaks) = (
        mechanism.layout().start_time,
        &mechanism.layout().break_times,
    );
    let breaks = breaks.iter().copied().filter(|t| *t > start);
    let first = std::iter::once(start).chain(breaks);
    let mut ends: Vec<f64> = first.collect();
    ends.push(ends[ends.len() - 1] + 1.0);
    ends.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect()
}

fn check_values(
    prepared: &PreparedMechanism,
    code: &dyn SceneCode,
    at: At,
) -> Result<(), CodeMismatch> {
    let mut motion = KeptRowMotion::new(prepared)?;
    let mut a = vec![0.0; prepared.v.len()];
    let t = prepared.start_time();
    let health = code.acceleration(t, &prepared.q, &prepared.v, &mut a);
    if health.is_nan() || health < LEAVE {
        return Err(CodeMismatch::Unhealthy {
            name: code.spec().name.to_string(),
            health,
        });
    }
    compare(&mut motion, code, (t, &prepared.q, &prepared.v))?;
    if at == At::Start {
        return Ok(());
    }
    let times = times(&prepared.mechanism);
    for k in 0..CODE_STATES.max(times.len()) {
        // The values are not related to any symmetry of a mechanism.
        let shift = |i: usize| (1.7 * (i + 1) as f64 + 2.9 * (k + 1) as f64).sin();
        let away = |by: f64| -> Vec<f64> {
            let unit = |j: usize| prepared.mechanism.space().unit(j, prepared.assembly.size);
            let columns = 0..prepared.v.len();
            columns.map(|j| by * shift(j) * unit(j)).collect()
        };
        let q = prepared
            .mechanism
            .space()
            .displaced(&prepared.q, 1.0, &away(DISTANCE));
        let faster = prepared.v.iter().zip(away(SPEED)).map(|(v, by)| v + by);
        let v: Vec<f64> = faster.collect();
        compare(&mut motion, code, (times[k % times.len()], &q, &v))?;
    }
    Ok(())
}

/// Compares Φ, C·v − b, accelerations and multipliers of the code and of the interpreter.
/// Accelerations and multipliers are compared only if the pivots of the code and of the interpreter
/// are large enough.
fn compare(
    motion: &mut KeptRowMotion<'_>,
    code: &dyn SceneCode,
    (t, q, v): (f64, &[f64], &[f64]),
) -> Result<(), CodeMismatch> {
    let mechanism = motion.mechanism();
    let (layout, name) = (mechanism.layout(), code.spec().name.as_ref());
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let comparison = |what, found: &[f64], expected: &[f64], size: &dyn Fn(usize) -> f64| {
        let comparison = Comparison {
            name,
            time: t,
            what,
            found,
            expected,
        };
        comparison.check(size)
    };
    let mut phi = vec![f64::NAN; layout.m];
    code.phi(t, q, &mut phi);
    comparison("Φ", &phi, &s.phi, &|i| mechanism.scales(&s).position(i))?;

    let mut residual = vec![f64::NAN; layout.rows()];
    code.velocity_residual(t, q, v, &mut residual);
    let expected: Vec<f64> = (0..layout.rows())
        .map(|i| layout.velocity_residual(&s, i, v))
        .collect();
    let size = |i: usize| mechanism.scales(&s).velocity(i, v);
    comparison("C·v − b", &residual, &expected, &size)?;

    let (mut a, mut expected) = (vec![f64::NAN; v.len()], vec![0.0; v.len()]);
    let health = code.acceleration(t, q, v, &mut a);
    let solved = motion.acceleration(t, q, v, &mut expected);
    if health.is_nan() || health < LEAVE || solved.is_err() {
        return Ok(());
    }
    let scene_size = motion.equations.at.size;
    let unit = |j: usize| mechanism.space().unit(j, scene_size);
    let largest = |x: &[f64]| {
        let shares = x.iter().enumerate().map(|(j, x)| x.abs() / unit(j));
        shares.fold(0.0, f64::max)
    };
    // Differences are relative to the accelerations of free bodies under these forces, because
    // forces cancel in a mechanism at rest.
    mechanism.twist(v, &mut s);
    mechanism.force(&mut s);
    let masses = mechanism.mass().iter().zip(&s.force);
    let free = masses.map(|(m, q)| if *m > 0.0 { q / m } else { 0.0 });
    let free: Vec<f64> = free.collect();
    let rate = largest(&expected)
        .max(largest(v).powi(2))
        .max(largest(&free));
    comparison("acceleration", &a, &expected, &|j| rate * unit(j))?;

    let mut lambda = vec![f64::NAN; layout.rows()];
    let mut expected = vec![0.0; layout.rows()];
    code.multipliers(t, q, v, &mut lambda);
    motion.write_multipliers(t, q, v, &mut expected)?;
    let size = expected.iter().fold(0.0, |a, l| f64::max(a, l.abs()));
    let forces = mechanism.mass().iter().enumerate();
    let inertia = forces.fold(0.0, |a, (j, m)| f64::max(a, m * rate * unit(j)));
    comparison("multiplier", &lambda, &expected, &|_| size.max(inertia))
}
