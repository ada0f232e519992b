//! A bar chart of times on a logarithmic axis. The shortest time is at the top.

use std::fmt::Write;

use crate::table::{Line, duration};

const WIDTH: f64 = 820.0;
/// Space for the names to the left of the bars, and for the times to the right of the longest bar.
const LEFT: f64 = 330.0;
const RIGHT: f64 = 80.0;
const TOP: f64 = 44.0;
const PITCH: f64 = 26.0;
const BAR: f64 = 17.0;

/// Draws the times of some candidates as SVG.
pub(crate) fn bars(lines: &[&Line]) -> String {
    let mut sorted = lines.to_vec();
    sorted.sort_by(|a, b| a.time.least.total_cmp(&b.time.least));
    let logs = || sorted.iter().map(|l| l.time.least.log10());
    let low = logs().fold(f64::INFINITY, f64::min).floor();
    let high = logs()
        .fold(f64::NEG_INFINITY, f64::max)
        .ceil()
        .max(low + 1.0);
    let x = |log: f64| LEFT + (log - low) / (high - low) * (WIDTH - LEFT - RIGHT);
    let bottom = TOP + PITCH * sorted.len() as f64;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" \
         font-size=\"12\" fill=\"#222222\" role=\"img\">\n<title>Time of one right-hand side</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n\
         <text x=\"12\" y=\"22\" font-size=\"14\" font-weight=\"bold\">Time of one right-hand side of the robot with trolley</text>\n",
        bottom + 34.0
    );
    // Writing to a string cannot fail.
    for decade in low as i32..=high as i32 {
        let at = x(f64::from(decade));
        let _ = writeln!(
            out,
            "<line x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{bottom}\" stroke=\"#d5d9dd\"/>\n\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#5f6870\">{}</text>",
            bottom + 18.0,
            decade_name(decade)
        );
    }
    for (k, line) in sorted.iter().enumerate() {
        let y = TOP + PITCH * k as f64 + 0.5 * (PITCH - BAR);
        let end = x(line.time.least.log10());
        let (fill, weight) = if line.is_ours() {
            ("#0072b2", "bold")
        } else {
            ("#9fb3c2", "normal")
        };
        let text = y + 0.5 * BAR + 4.0;
        let _ = writeln!(
            out,
            "<rect x=\"{LEFT}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{BAR}\" fill=\"{fill}\"/>\n\
             <text x=\"{}\" y=\"{text:.1}\" text-anchor=\"end\" font-weight=\"{weight}\">{}</text>\n\
             <text x=\"{:.1}\" y=\"{text:.1}\" stroke=\"#ffffff\" stroke-width=\"4\" paint-order=\"stroke\">{}</text>",
            end - LEFT,
            LEFT - 8.0,
            line.plain_title(),
            end + 6.0,
            duration(line.time.least)
        );
    }
    out + "</svg>\n"
}

/// Formats 10^decade seconds.
fn decade_name(decade: i32) -> String {
    let (unit, power) = match decade {
        ..=-7 => ("ns", decade + 9),
        -6..=-4 => ("µs", decade + 6),
        -3..=-1 => ("ms", decade + 3),
        0.. => ("s", decade),
    };
    format!("{} {unit}", 10.0_f64.powi(power))
}
