//! Generated code for the runs of a sweep. The code is generated once, without a compiler. Its
//! inputs are the numbers that the varied keys affect.

use std::sync::Arc;

use dynamics::code::SharedCode;
use dynamics::{CodeMismatch, MotionOptions, PreparedMechanism, SceneCode};
use model::Registry;
use scene_codegen::{CodeError, LANES, NotAnInput, Tape};

use super::run::UnvariedScene;
use crate::study::Study;

/// Sweeps with fewer runs are interpreted, because the generation of the code takes as long as 10
/// to 30 runs.
const FEW: u64 = 100;

/// The code of all runs of a sweep.
pub(super) struct SweepCode {
    tape: Tape,
}

impl SweepCode {
    /// Generates the code for runs of a scene with other numbers at these keys. `described` is the
    /// scene without changes.
    ///
    /// # Errors
    /// Returns the reason why runs are interpreted.
    pub(super) fn new(
        (name, text): (&str, &str),
        registry: &Registry,
        described: Option<&UnvariedScene>,
        (keys, runs): (&[String], u64),
    ) -> Result<Self, String> {
        if runs < FEW {
            return Err(format!("code is generated for at least {FEW} runs"));
        }
        let described = described.ok_or("the scene without changed values cannot be assembled")?;
        // Settings that are not numbers of the equations, such as a tolerance, need no input.
        let is_of_run = |key: &&String| key.starts_with("simulate.");
        let mut keys: Vec<String> = keys.iter().filter(|key| !is_of_run(key)).cloned().collect();
        let tape = loop {
            match scene_codegen::scene_tape(name, text, registry, &keys) {
                Ok(tape) => break tape,
                Err(CodeError::Input(NotAnInput::OfKey { key, why }))
                    if *why == NotAnInput::Nothing && keys.contains(&key) =>
                {
                    keys.retain(|other| *other != key);
                }
                Err(error) => return Err(error.to_string()),
            }
        };
        let code = Self { tape };
        let fits = code.fit(described.prepared().clone(), PreparedMechanism::with_code);
        fits.map_err(|e| e.to_string())?;
        Ok(code)
    }

    /// Describes the code as text.
    pub(super) fn describe(&self) -> String {
        let inputs = self.tape.inputs().map_or(0, |inputs| inputs.list.len());
        let inputs = match inputs {
            1 => "1 number".to_owned(),
            n => format!("{n} numbers"),
        };
        format!(
            "generated code, {LANES} runs at the same time; its inputs are {inputs} of each run ({})",
            self.tape.spec().operations
        )
    }

    /// Prepares the generated code for a run, with the values of the varied keys. Returns `None` if
    /// the equations of the run must be interpreted.
    pub(super) fn of_run(
        &self,
        study: &mut Study,
        described: Option<&UnvariedScene>,
        options: &MotionOptions,
    ) -> Option<Tape> {
        let prepared = study.prepared.clone();
        let fits = if described.is_some_and(|described| described.decides(&prepared)) {
            self.fit(prepared, PreparedMechanism::with_known_code)
        } else {
            self.fit(prepared, PreparedMechanism::with_code)
        };
        let (tape, prepared) = fits.ok()?;
        prepared.code_for(options).ok()?;
        study.prepared = prepared;
        Some(tape)
    }

    fn fit(
        &self,
        prepared: PreparedMechanism,
        with: fn(PreparedMechanism, Arc<SharedCode>) -> Result<PreparedMechanism, CodeMismatch>,
    ) -> Result<(Tape, PreparedMechanism), CodeMismatch> {
        let tape = self.tape.of_mechanism(&prepared.mechanism)?;
        let spec = tape.spec();
        let moved = prepared.on_rows(&spec.kept, &spec.position_kept);
        let prepared = with(moved.unwrap_or(prepared), Arc::new(tape.clone()))?;
        Ok((tape, prepared))
    }
}
