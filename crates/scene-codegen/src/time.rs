//! Functions of time as text.

use std::fmt::Write;

use model::Function;
use model::function::Parts;
use model::record::{FunctionForm, TimeFunction};

/// The expression of the jet of a function at `t`, and the support functions that it needs.
pub(crate) fn jet(function: &Function) -> (String, &'static [&'static str]) {
    match function.parts() {
        Parts::Polynomial(c) => (format!("polynomial(t, &{c:?})"), &["polynomial"]),
        Parts::Harmonic {
            amplitude,
            omega,
            phase,
            offset,
        } => (
            format!("harmonic(t, [{amplitude:?}, {omega:?}, {phase:?}, {offset:?}])"),
            &["cos_sin", "harmonic"],
        ),
        Parts::Steps { start, steps } => (format!("steps(t, {start:?}, &{steps:?})"), &["steps"]),
        Parts::Spline {
            times,
            values,
            curvatures,
        } => {
            let points = times.iter().zip(values).zip(curvatures);
            let points: Vec<[f64; 3]> = points.map(|((t, f), k)| [*t, *f, *k]).collect();
            (format!("spline(t, &{points:?})"), &["spline"])
        }
        Parts::Lines { times, values } => {
            let points: Vec<[f64; 2]> = times.iter().zip(values).map(|(t, f)| [*t, *f]).collect();
            (format!("lines(t, &{points:?})"), &["lines"])
        }
    }
}

/// The body of the function that evaluates all jets: `[f, ḟ, f̈]` one after the other.
pub(crate) fn jets<'f>(
    functions: impl Iterator<Item = &'f TimeFunction>,
) -> (String, Vec<&'static str>) {
    let (mut text, mut names, mut support) = (String::new(), String::new(), Vec::new());
    for (k, f) in functions.enumerate() {
        let (function, offset) = f.parts();
        let minus = if offset == 0.0 {
            String::new()
        } else {
            format!(" - {offset:?}")
        };
        if f.form() == FunctionForm::Sine {
            // Evaluated with the cosine before it.
            let _ = write!(names, "f{k}, d{k}, dd{k},");
            continue;
        }
        let (call, needed) = jet(function);
        support.extend(needed);
        // Writing to a string cannot fail.
        let _ = write!(text, "let [f{k}, d{k}, dd{k}] = {call};");
        if f.form() == FunctionForm::Cosine {
            support.extend(["cos_sin", "turning"]);
            let sine = k + 1;
            let _ = write!(
                text,
                "let [[f{k}, d{k}, dd{k}], [f{sine}, d{sine}, dd{sine}]] = turning([f{k}{minus}, d{k}, dd{k}]);"
            );
            let _ = write!(names, "f{k}, d{k}, dd{k},");
        } else {
            let _ = write!(names, "f{k}{minus}, d{k}, dd{k},");
        }
    }
    (format!("{text} [{names}]"), support)
}
