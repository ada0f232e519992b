//! Functions of time, and numbers in place of functions.

use super::Values;

/// Returns a number or a function.
pub(super) fn number_or_function(values: &mut Values<'_>) -> String {
    if values.numbers.once_in(2) {
        values.number()
    } else {
        function(values)
    }
}

/// Returns a function of time.
pub(super) fn function(values: &mut Values<'_>) -> String {
    let n = values.numbers.below(4);
    let list = |values: &mut Values<'_>, n: usize| {
        let all: Vec<String> = (0..n).map(|_| values.number()).collect();
        format!("[{}]", all.join(", "))
    };
    match values.numbers.below(5) {
        0 => {
            let mut from = 0.0;
            let steps: Vec<String> = (0..n)
                .map(|_| {
                    let to = from + 0.01 * f64::from(values.numbers.between(1, 9));
                    let step = format!(
                        "{{ from = {from:?}, to = {to:?}, by = {} }}",
                        values.number()
                    );
                    from = to;
                    step
                })
                .collect();
            format!(
                "{{ type = \"steps\", start = {}, steps = [{}] }}",
                values.number(),
                steps.join(", ")
            )
        }
        1 => format!("{{ type = \"constant-rate\", rate = {} }}", values.number()),
        2 => format!(
            "{{ type = \"polynomial\", coefficients = {} }}",
            list(values, n)
        ),
        3 => format!(
            "{{ type = \"harmonic\", amplitude = {}, omega = {}, phase = {}, offset = {} }}",
            values.number(),
            values.positive(),
            values.number(),
            values.number()
        ),
        _ => {
            let times: Vec<String> = (0..n + 2)
                .map(|k| format!("{:?}", k as f64 * 0.3))
                .collect();
            format!(
                "{{ type = \"table\", times = [{}], values = {} }}",
                times.join(", "),
                list(values, n + 2)
            )
        }
    }
}
