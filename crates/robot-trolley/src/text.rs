//! The printed text: published results, and computed results for comparison.

use pfaff::model::{Mechanism, System};
use pfaff::solvability::Analysis;

use crate::variants::{DELETED, TOLERANCE, Variant, motion_difference, reaction_difference};

/// Reactions that are not unique according to the paper.
const PUBLISHED: [&str; 6] = ["B", "C", "W1", "W2", "W3", "W4"];

/// Sizes and ranks.
pub(crate) fn structure(a: &Analysis) -> String {
    let rows = a.holonomic_rows + a.nonholonomic_rows;
    format!(
        "Four-wheel robot with a one-wheel trolley (Wojtyra, Frączek 2013, section 4; dimensions reconstructed)\n\n\
         {:<28}{:>10}{:>12}\n{}",
        "",
        "computed",
        "published",
        [
            ("bodies", a.bodies, 7),
            ("coordinates n", a.coordinates, 21),
            ("holonomic rows m", a.holonomic_rows, 17),
            ("knife edges h", a.nonholonomic_rows, 5),
            ("rows of C", rows, 22),
            ("rank Φq", a.rank_holonomic, 17),
            ("rank Ψ", a.rank_nonholonomic, 4),
            ("rank C", a.decision.rank, 20),
            ("degree of redundancy p", a.decision.redundancy, 2),
        ]
        .iter()
        .map(|(what, found, published)| format!("{what:<28}{found:>10}{published:>12}\n"))
        .collect::<String>()
    )
}

/// Whether two instants have the same rank and the same verdicts.
pub(crate) fn same_verdicts(a: &Analysis, b: &Analysis) -> bool {
    let words = |x: &Analysis| -> Vec<&str> {
        x.reactions
            .iter()
            .map(|r| r.wrench.verdict.word())
            .collect()
    };
    a.decision.rank == b.decision.rank && words(a) == words(b)
}

/// The fourteen verdicts.
pub(crate) fn verdicts(a: &Analysis, agreeing: usize, instants: usize) -> String {
    let mut out = format!(
        "Solvability of the reactions at t = 0: unique where B_X = 0\n\n{:<12}{:<15}{:<8}{:>12}  {:<12}published\n",
        "reaction", "type", "rows", "‖B_X‖", "verdict"
    );
    for r in &a.reactions {
        let rows: Vec<String> = r.rows.iter().map(|row| (row.row + 1).to_string()).collect();
        let published = if PUBLISHED.contains(&r.name.as_str()) {
            "not unique"
        } else {
            "unique"
        };
        out.push_str(&format!(
            "{:<12}{:<15}{:<8}{:>12.1e}  {:<12}{published}\n",
            r.name,
            r.kind,
            rows.join(", "),
            r.wrench.margin,
            r.wrench.verdict.word().replace('_', " "),
        ));
    }
    out.push_str(&format!(
        "\nThe same rank and verdicts at {agreeing} of {instants} instants of the motion.\n\nDependencies:\n"
    ));
    for d in &a.dependencies {
        out.push_str(&format!("- {}\n", d.text));
    }
    out
}

/// Comparison of the variants.
pub(crate) fn variants(mechanism: &Mechanism, variants: &[Variant]) -> String {
    let mut out = format!(
        "Elimination of redundant rows: three variants, rtol = atol = {TOLERANCE:e}, t = 0 … 10 s\n\n"
    );
    let labels = &mechanism.layout().labels;
    for (k, v) in variants.iter().enumerate() {
        let rows: Vec<String> = v
            .deleted
            .iter()
            .map(|r| labels[r - 1].to_string())
            .collect();
        let s = &v.summary;
        out.push_str(&format!(
            "variant {}: without rows {}\n           {} steps, {} evaluations, {:.1} ms, |Φ| ≤ {:.1e}, |C·v − b| ≤ {:.1e}\n",
            k + 1,
            rows.join(" and "),
            s.steps,
            s.evaluations,
            1e3 * s.wall_seconds,
            s.max_position_residual,
            s.max_velocity_residual,
        ));
        for event in &s.events {
            out.push_str(&format!(
                "           t = {:.4} s: {}\n",
                event.time, event.text
            ));
        }
    }
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let header: Vec<String> = pairs
        .iter()
        .map(|(a, b)| format!("{:>12}", format!("{} – {}", a + 1, b + 1)))
        .collect();
    out.push_str(&format!(
        "\nLargest difference between variants (rad, m, N, N·m)\n\n{:<14}{}\n",
        "",
        header.concat()
    ));
    let line = |what: &str, difference: &dyn Fn(&Variant, &Variant) -> f64, note: &str| {
        let cells: Vec<String> = pairs
            .iter()
            .map(|&(a, b)| format!("{:>12.1e}", difference(&variants[a], &variants[b])))
            .collect();
        format!("{what:<14}{}  {note}\n", cells.concat())
    };
    out.push_str(&line("motion", &motion_difference, "the same"));
    for (k, group) in mechanism.layout().groups.iter().enumerate() {
        let row = group.rows.row(0) + 1;
        let deleted_in_all = group.rows.len() == 1 && DELETED.iter().all(|d| d.contains(&row));
        let note = match PUBLISHED.contains(&group.name.as_str()) {
            true if deleted_in_all => {
                "the choice deletes its row in all three variants, so the reaction is zero"
            }
            true => "a choice: different in each",
            false => "the same",
        };
        out.push_str(&line(
            &group.name,
            &|a, b| reaction_difference(a, b, k),
            note,
        ));
    }
    out
}

/// Comparison of the motion with generated code and the motion of a variant.
pub(crate) fn generated(variant: &Variant, generated: &Variant) -> String {
    let [a, b] = generated.deleted;
    let s = &generated.summary;
    format!(
        "On code generated for the scene, without rows {a} and {b}: {} steps, {} evaluations, {:.1} ms; the motion differs by {:.1e}\n",
        s.steps,
        s.evaluations,
        1e3 * s.wall_seconds,
        motion_difference(variant, generated),
    )
}
