//! Functions of time as text of generated code.

use std::fmt::Write;

use model::Function;
use model::function::Parts;
use model::record::{FunctionForm, TimeFunction};

/// Returns the expression for value and derivatives of a function at `t`, and the support functions
/// that the expression needs. `numbers` contains the texts of the parameters, in the order of
/// [`Parts::numbers`].
pub(crate) fn jet(function: &Function, numbers: &[String]) -> (String, &'static [&'static str]) {
    let list = numbers.join(", ");
    let points = |numbers: &[String], each: usize| {
        let points = numbers.chunks(each);
        let points: Vec<String> = points.map(|p| format!("[{}]", p.join(", "))).collect();
        points.join(", ")
    };
    match function.parts() {
        Parts::Polynomial(_) => (format!("polynomial(t, &[{list}])"), &["polynomial"]),
        Parts::Harmonic { .. } => (format!("harmonic(t, [{list}])"), &["cos_sin", "harmonic"]),
        Parts::Steps { .. } => {
            let (start, steps) = numbers.split_at(1);
            let (start, steps) = (start.concat(), points(steps, 3));
            (format!("steps(t, {start}, &[{steps}])"), &["steps"])
        }
        Parts::Spline { .. } => (format!("spline(t, &[{}])", points(numbers, 3)), &["spline"]),
        Parts::Lines { .. } => (format!("lines(t, &[{}])", points(numbers, 2)), &["lines"]),
        // `recordable` rejects mechanisms with expressions.
        Parts::Expression(_) => ("[f64::NAN; 3]".to_owned(), &[]),
    }
}

/// Returns the body of the function that evaluates `[f, ḟ, f̈]` of all functions in sequence.
/// `input` returns the text of a parameter that is an input. The arguments of `input` are the index
/// of the function and the index of the parameter in [`TimeFunction::numbers`].
pub(crate) fn jets<'f>(
    functions: impl Iterator<Item = &'f TimeFunction>,
    input: impl Fn(usize, usize) -> Option<String>,
) -> (String, Vec<&'static str>) {
    let (mut text, mut names, mut support) = (String::new(), String::new(), Vec::new());
    for (k, f) in functions.enumerate() {
        let (function, offset) = f.parts();
        let numbers = f.numbers().into_iter().enumerate();
        let numbers = numbers.map(|(n, x)| input(k, n).unwrap_or_else(|| format!("{x:?}")));
        let mut numbers: Vec<String> = numbers.collect();
        let last = numbers.pop().unwrap_or_default();
        let minus = if offset == 0.0 && input(k, numbers.len()).is_none() {
            String::new()
        } else {
            format!(" - {last}")
        };
        if f.form() == FunctionForm::Sine {
            // The sine was evaluated together with the preceding cosine.
            let _ = write!(names, "f{k}, d{k}, dd{k},");
            continue;
        }
        let (call, needed) = jet(function, &numbers);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// In the text, every parameter of a function is at its own index, whether it is an input or
    /// not.
    #[test]
    fn numbers_of_functions_stand_where_they_are_used() {
        let of = |function: Result<Function, model::FunctionError>| {
            let function = function.expect("a function");
            let n = function.parts().numbers().len();
            let names: Vec<String> = (0..n).map(|k| format!("p[{k}]")).collect();
            jet(&function, &names).0
        };
        assert_eq!(
            of(Function::polynomial(&[1.0, 2.0])),
            "polynomial(t, &[p[0], p[1]])"
        );
        assert_eq!(
            of(Function::harmonic(1.0, 2.0, 3.0, 4.0)),
            "harmonic(t, [p[0], p[1], p[2], p[3]])"
        );
        assert_eq!(
            of(Function::steps(0.0, &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])),
            "steps(t, p[0], &[[p[1], p[2], p[3]], [p[4], p[5], p[6]]])"
        );
        assert_eq!(
            of(Function::table(&[0.0, 1.0], &[5.0, 6.0])),
            "spline(t, &[[p[0], p[1], p[2]], [p[3], p[4], p[5]]])"
        );
        assert_eq!(
            of(Function::lines(&[0.0, 1.0], &[5.0, 6.0])),
            "lines(t, &[[p[0], p[1]], [p[2], p[3]]])"
        );
    }
}
