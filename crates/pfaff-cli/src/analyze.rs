//! `pfaff analyze`: the verdict of every reaction, for people or as JSON.

use pfaff::report::documents::GroupDocument;
use pfaff::report::{AnalysisDocument, Proof, write_json};
use pfaff::solvability::{ReactionVerdict, Verdict};
use pfaff::{Findings, Overrides};

use crate::Outcome;
use crate::args::Analyze;
use crate::input::{Source, rows_from_zero};
use crate::output::{Failure, columns, count, print};

pub(crate) fn run(arguments: &Analyze) -> Outcome {
    if !(arguments.at_time >= 0.0 && arguments.at_time.is_finite()) {
        return Err(Failure::input(format!(
            "--at-time is {}, need a time ≥ 0",
            arguments.at_time
        )));
    }
    let drop = rows_from_zero(arguments.drop.as_deref())?;
    let source = Source::read(&arguments.scene)?;
    let study = source.study(&Overrides {
        drop: drop.clone(),
        ..Overrides::default()
    })?;
    let findings = study
        .analyse_at(arguments.at_time, drop.as_deref(), &arguments.combine)
        .map_err(|e| source.failure(e))?;
    let name = &study.scene.description.name;
    if arguments.json {
        let mut out = Vec::new();
        // The rank has a clear gap; it is not proved.
        let proof = Proof {
            permanent: findings.permanent,
            certified: false,
        };
        let mut document = AnalysisDocument::new(name, &findings.analysis, proof);
        document.groups = findings
            .groups
            .iter()
            .map(|(name, judgement)| GroupDocument {
                name: name.clone(),
                verdict: judgement.into(),
            })
            .collect();
        write_json(&mut out, &document).map_err(|e| Failure::stopped(e.to_string()))?;
        return print(&String::from_utf8_lossy(&out));
    }
    print(&describe(name, &findings))
}

/// The analysis in words and columns.
fn describe(name: &str, findings: &Findings) -> String {
    let a = &findings.analysis;
    let d = &a.decision;
    let e = &d.evidence;
    let mut out = format!(
        "{name} at t = {} s\n\
         {}, {}, {}: {} holonomic, {} nonholonomic\n\
         rank {} (Φq alone {}, Ψ alone {}), redundancy {}, mobility {}\n\
         evidence: σ_r = {:.3e}, σ_r+1 = {:.1e}, tolerance {:.1e}, |Φ| = {:.1e}: {}, {}\n\n",
        a.time,
        count(a.bodies, "body", "bodies"),
        count(a.coordinates, "coordinate", "coordinates"),
        count(a.holonomic_rows + a.nonholonomic_rows, "row", "rows"),
        a.holonomic_rows,
        a.nonholonomic_rows,
        d.rank,
        a.rank_holonomic,
        a.rank_nonholonomic,
        d.redundancy,
        a.mobility(),
        e.sigma_r,
        e.sigma_next,
        e.tolerance,
        e.constraint_residual,
        if d.is_decided() {
            "decided"
        } else {
            "UNDECIDED"
        },
        match findings.permanent {
            Some(true) => "the same redundancy at other configurations",
            Some(false) => "a singular configuration: the redundancy is another one elsewhere",
            None => "not compared with other configurations",
        },
    );
    let header = [
        "reaction",
        "type",
        "rows",
        "verdict",
        "margin",
        "components",
    ];
    let mut table = vec![header.map(str::to_owned).to_vec()];
    table.extend(a.reactions.iter().map(line));
    out.push_str(&columns(&table));
    for (name, judgement) in &findings.groups {
        let (word, margin) = (words(&judgement.verdict), judgement.margin);
        out.push_str(&format!("\n{name}: {word} (margin {margin:.1e})\n"));
    }
    if !a.dependencies.is_empty() {
        out.push_str("\nDependencies:\n");
        for dependency in &a.dependencies {
            out.push_str(&format!("- {}\n", dependency.text));
        }
    }
    for warning in &a.warnings {
        out.push_str(&format!("\nwarning: {warning}\n"));
    }
    out
}

fn line(r: &ReactionVerdict) -> Vec<String> {
    let rows = match (r.rows.first(), r.rows.last()) {
        (Some(a), Some(b)) if a.row != b.row => format!("{}–{}", a.row + 1, b.row + 1),
        (Some(a), _) => (a.row + 1).to_string(),
        _ => String::new(),
    };
    let components: Vec<String> = match r.wrench.verdict {
        Verdict::Unique => Vec::new(),
        _ => r
            .components
            .iter()
            .map(|c| format!("{} {}", c.name, words(&c.judgement.verdict)))
            .collect(),
    };
    vec![
        r.name.clone(),
        r.kind.to_owned(),
        rows,
        words(&r.wrench.verdict).to_owned(),
        format!("{:.1e}", r.wrench.margin),
        components.join(", "),
    ]
}

fn words(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Unique => "unique",
        Verdict::NotUnique => "not unique",
        _ => "undecided",
    }
}
