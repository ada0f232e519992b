//! The equations in the frame of one body. If a mechanism moves freely in the plane, the
//! accelerations relative to this frame do not depend on the orientation of the mechanism. The
//! lever arms on this body are constant in the frame, so the generated code contains fewer products
//! than with ground axes. A rotation of the whole mechanism does not change the coefficients of the
//! equations in the frame, so this rotation does not make a pivot small.
//!
//! The frame has no velocity; it is only rotated by the current angle θ of the body. Positions and
//! velocities are rotated by −θ, and accelerations back by θ. Two rows that are the components x
//! and y of one vector are rotated together. It is not possible to decide from the joints whether
//! this rotation is permitted. Therefore C, Γ and Q after the rotation are compared with C, Γ and Q
//! of the rotated mechanism, up to rounding, at states far from any motion.

use model::System;
use model::record::Input;
use symbolic::Value;

use crate::equations::{ANYWHERE, Equations, Source, anywhere, replay, results};
use crate::sampled::SampledProgram;
use crate::subject::Subject;

/// Largest difference between the rotated equations and the equations in the frame, as a fraction
/// of the largest entry.
const SAME: f64 = 1e-10;

/// A frame that is rotated by the angle θ relative to the ground.
#[derive(Clone)]
pub(crate) struct Frame {
    /// cos θ and sin θ.
    turn: Option<[Value; 2]>,
    /// Indices of x and y of each body, in q and in v.
    bodies: Vec<[usize; 2]>,
    /// Pairs of rows that are the components x and y of one vector.
    rows: Vec<[usize; 2]>,
}

/// C, Γ and Q in a frame.
#[derive(Clone)]
pub(crate) struct FrameEquations {
    pub(crate) frame: Frame,
    /// The rows of C as dense rows.
    pub(crate) c: Vec<Vec<Value>>,
    pub(crate) gamma: Vec<Value>,
    pub(crate) force: Vec<Value>,
}

impl Frame {
    /// Returns the frame of the ground, without rotation.
    fn ground() -> Self {
        Self {
            turn: None,
            bodies: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Converts quantities of the rows from ground components to components in the frame.
    pub(crate) fn rows_in(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        self.turned(code, x, &self.rows, false)
    }

    /// Converts quantities of the rows from components in the frame to ground components.
    pub(crate) fn rows_out(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        self.turned(code, x, &self.rows, true)
    }

    /// Converts velocities or accelerations from components in the frame to ground components.
    pub(crate) fn velocities_out(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        self.turned(code, x, &self.bodies, true)
    }

    /// Converts velocities or forces from ground components to components in the frame.
    fn velocities_in(&self, code: &mut SampledProgram, x: &[Value]) -> Vec<Value> {
        self.turned(code, x, &self.bodies, false)
    }

    fn turned(
        &self,
        code: &mut SampledProgram,
        x: &[Value],
        pairs: &[[usize; 2]],
        out: bool,
    ) -> Vec<Value> {
        let mut turned = x.to_vec();
        if let Some([cos, sin]) = self.turn {
            let p = &mut code.program;
            let sin = if out { p.neg(sin) } else { sin };
            for &[i, j] in pairs {
                let [cx, sx, cy, sy] =
                    [(cos, x[i]), (sin, x[i]), (cos, x[j]), (sin, x[j])].map(|(a, b)| p.mul(a, b));
                turned[i] = p.add(cx, sy);
                turned[j] = p.sub(cy, sx);
            }
        }
        turned
    }
}

impl FrameEquations {
    /// Returns the equations in the frame of the ground.
    pub(crate) fn from_ground(e: &Equations) -> Self {
        Self {
            frame: Frame::ground(),
            c: e.c.clone(),
            gamma: e.gamma.clone(),
            force: e.force.clone(),
        }
    }

    /// Returns the equations in the frame of the body whose angle has this index in q.
    pub(crate) fn from_body(
        e: &mut Equations,
        subject: &Subject<'_>,
        angle: usize,
    ) -> Option<Self> {
        let recording = &e.recording;
        let mechanism = &subject.prepared.mechanism;
        let angles: Vec<usize> = recording
            .inputs
            .iter()
            .filter_map(|i| match i {
                Input::Cos(k) => Some(*k),
                _ => None,
            })
            .collect();
        let labels = &mechanism.layout().labels;
        let is_pair = |i: &usize| {
            let [a, b] = [&labels[*i], &labels[i + 1]];
            a.joint == b.joint && (a.row, b.row) == ("x", "y")
        };
        let rows = (0..labels.len().saturating_sub(1)).filter(is_pair);
        let of = |input| e.input(Source::Mechanism(input));
        let frame = Frame {
            turn: Some([of(Input::Cos(angle))?, of(Input::Sin(angle))?]),
            bodies: angles.iter().map(|&k| [k - 2, k - 1]).collect(),
            rows: rows.map(|i| [i, i + 1]).collect(),
        };
        let inputs = inputs_in(e, &frame, angle)?;
        let recording = e.recording.clone();
        let values = replay(&mut e.code, &recording, &inputs, &e.numbers);
        let (c, of) = results(&mut e.code, &recording, &values);
        let (gamma, mut force) = (of(&recording.gamma), of(&recording.force));
        // Gravity has a fixed direction relative to the ground, so it is rotated.
        let weight = e.weight();
        let seen = frame.velocities_in(&mut e.code, &weight);
        for ((force, weight), seen) in force.iter_mut().zip(weight).zip(seen) {
            let applied = e.code.program.sub(*force, weight);
            *force = e.code.program.add(applied, seen);
        }
        Some(Self {
            frame,
            c,
            gamma,
            force,
        })
    }

    /// Returns whether, for each vector, the independent rows contain either both components or no
    /// component.
    pub(crate) fn keeps_pairs(&self, kept: &[usize]) -> bool {
        let pairs = self.frame.rows.iter();
        pairs
            .into_iter()
            .all(|[i, j]| kept.contains(i) == kept.contains(j))
    }
}

/// Returns the inputs of the mechanism in the frame of a body.
fn inputs_in(e: &mut Equations, frame: &Frame, angle: usize) -> Option<Vec<Value>> {
    let recording = e.recording.clone();
    let all: Vec<Value> = recording
        .inputs
        .iter()
        .map(|&i| e.input(Source::Mechanism(i)))
        .collect::<Option<_>>()?;
    let at = |input: Input| recording.inputs.iter().position(|&i| i == input);
    let (n_q, n_v) = (3 * frame.bodies.len(), 3 * frame.bodies.len());
    let gather = |make: fn(usize) -> Input, n: usize| -> Option<Vec<Value>> {
        (0..n).map(|k| Some(all[at(make(k))?])).collect()
    };
    let (q, v) = (
        gather(Input::Coordinate, n_q)?,
        gather(Input::Velocity, n_v)?,
    );
    let p = &mut e.code.program;
    let mut away = q.clone();
    for &[i, j] in &frame.bodies {
        away[i] = p.sub(q[i], q[angle - 2]);
        away[j] = p.sub(q[j], q[angle - 1]);
        away[j + 1] = p.sub(q[j + 1], q[angle]);
    }
    let q = frame.velocities_in(&mut e.code, &away);
    let v = frame.velocities_in(&mut e.code, &v);
    let [cos, sin] = frame.turn?;
    let p = &mut e.code.program;
    let (one, zero) = (p.number(1.0), p.number(0.0));
    let mut seen = all.clone();
    for (k, input) in recording.inputs.iter().enumerate() {
        seen[k] = match *input {
            Input::Coordinate(i) => q[i],
            Input::Velocity(i) => v[i],
            Input::Cos(i) if i == angle => one,
            Input::Sin(i) if i == angle => zero,
            Input::Cos(i) => {
                let (c, s) = (all[k], all[at(Input::Sin(i))?]);
                let (a, b) = (p.mul(c, cos), p.mul(s, sin));
                p.add(a, b)
            }
            Input::Sin(i) => {
                let (s, c) = (all[k], all[at(Input::Cos(i))?]);
                let (a, b) = (p.mul(s, cos), p.mul(c, sin));
                p.sub(a, b)
            }
            Input::Rotation { .. } | Input::Function { .. } => all[k],
        };
    }
    Some(seen)
}

/// Returns whether the equations of a mechanism may be solved in the frame of the body whose angle
/// has this index. C, Γ and Q in this frame must be equal to the rotated C, Γ and Q, also at states
/// that violate the constraints.
pub(crate) fn may_be_seen_from(subject: &Subject<'_>, angle: usize) -> bool {
    let elsewhere = Subject {
        inputs: subject.inputs.clone(),
        ..Subject::at_states(
            subject.prepared,
            (0..ANYWHERE).map(|k| anywhere(subject, k)).collect(),
        )
    };
    let mut e = Equations::new(&elsewhere);
    let Some(seen) = FrameEquations::from_body(&mut e, &elsewhere, angle) else {
        return false;
    };
    let frame = &seen.frame;
    let code = &mut e.code;
    let mut pairs: Vec<(Vec<Value>, Vec<Value>)> = vec![
        (frame.rows_in(code, &e.gamma), seen.gamma.clone()),
        (frame.velocities_in(code, &e.force), seen.force.clone()),
    ];
    // Computes S·C·T: first the rows are rotated, then the columns.
    for j in 0..e.force.len() {
        let column: Vec<Value> = e.c.iter().map(|row| row[j]).collect();
        let column = frame.rows_in(code, &column);
        for (i, value) in column.into_iter().enumerate() {
            e.c[i][j] = value;
        }
    }
    for (row, seen) in e.c.iter().zip(&seen.c) {
        pairs.push((frame.velocities_in(code, row), seen.clone()));
    }
    pairs.iter().all(|(turned, seen)| {
        let mut by = 0.0_f64;
        let mut size = 1.0_f64;
        for (a, b) in turned.iter().zip(seen) {
            let (a, b) = (code.at(*a).to_vec(), code.at(*b).to_vec());
            for (a, b) in a.iter().zip(b) {
                by = by.max((a - b).abs());
                size = size.max(b.abs());
            }
        }
        by <= SAME * size
    })
}
