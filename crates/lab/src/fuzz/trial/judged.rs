//! Properties that an initial state and the verdicts at this state must have.

use pfaff::documents::AnalysisDocument;
use pfaff::model::System;
use pfaff::rank::RankStatus;
use pfaff::report::write_json;
use pfaff::solvability::Verdict;
use pfaff::{ConfigurationAnalysis, Study};

use super::reach::named;

/// Checks that a consistent initial state has finite values, and that the number of independent
/// rows is the rank.
pub(super) fn start(study: &Study) {
    let p = &study.prepared;
    assert!(
        p.q.iter().chain(&p.v).all(|x| x.is_finite()),
        "the start is not finite"
    );
    let layout = p.mechanism.layout();
    assert_eq!((p.q.len(), p.v.len()), (layout.n_q, layout.n_v));
    assert_eq!(p.decision.kept.len(), p.decision.rank, "kept rows");
    assert_eq!(p.decision.rank + p.decision.redundancy, layout.rows());
}

/// Checks that the verdicts are consistent with each other, with the rank and with the
/// dependencies. Also checks that the document is readable.
pub(super) fn check(configuration: &ConfigurationAnalysis<'_>) {
    let analysis = &configuration.analysis;
    let decision = &analysis.decision;
    let rows = analysis.holonomic_rows + analysis.nonholonomic_rows;
    assert_eq!(decision.rank + decision.redundancy, rows);
    assert!(decision.rank <= analysis.velocities);
    if matches!(decision.status, RankStatus::Undecided(_)) {
        for r in &analysis.reactions {
            assert!(
                r.wrench.verdict != Verdict::NotUnique || decision.redundancy > 0,
                "{}",
                r.name
            );
        }
    } else {
        verdicts(configuration);
    }
    if let Err(e) = configuration.groups(&[]) {
        named(&e);
    }
    document(configuration);
}

fn verdicts(configuration: &ConfigurationAnalysis<'_>) {
    let analysis = &configuration.analysis;
    let decision = &analysis.decision;
    let evidence = analysis.evidence();
    if evidence.certificate.is_none() && decision.rank > 0 {
        assert!(
            evidence.sigma_r > evidence.tolerance,
            "σ_r = {:e} ≤ {:e}",
            evidence.sigma_r,
            evidence.tolerance
        );
        assert!(
            evidence.sigma_next <= evidence.tolerance,
            "σ_next = {:e} > {:e}",
            evidence.sigma_next,
            evidence.tolerance
        );
    }
    // Within a stated tolerance some dependencies may be undecided. A warning states this, and
    // undecided dependencies are not listed.
    let listed = analysis.dependencies.len();
    let is_open = analysis.warnings.iter().any(|w| w.contains("not listed"));
    assert!(
        listed == decision.redundancy || is_open && listed < decision.redundancy,
        "{listed} dependencies of {} redundant rows",
        decision.redundancy
    );
    for d in &analysis.dependencies {
        let largest = d.coefficients.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        assert!((largest - 1.0).abs() < 1e-12, "{:?}", d.coefficients);
        assert!(!d.text.is_empty());
    }
    let depends = |row: usize| analysis.dependencies.iter().any(|d| d.rows.contains(&row));
    for r in &analysis.reactions {
        if decision.redundancy == 0 {
            assert_eq!(
                r.wrench.verdict,
                Verdict::Unique,
                "`{}` without any redundancy",
                r.name
            );
        }
        // The multiplier of a row is not unique if and only if the row is in a dependency. The
        // dependencies are computed by another method.
        for row in &r.rows {
            match &row.judgement.verdict {
                Verdict::Unique => assert!(
                    !depends(row.row),
                    "row {} is unique although it depends on other rows",
                    row.row + 1
                ),
                Verdict::NotUnique => assert!(
                    depends(row.row) || is_open,
                    "row {} is not unique although it depends on no other row",
                    row.row + 1
                ),
                Verdict::Undecided { reason } => assert!(!reason.is_empty()),
                other => panic!("an unknown verdict: {other:?}"),
            }
        }
        let free = r
            .rows
            .iter()
            .any(|row| row.judgement.verdict == Verdict::NotUnique);
        let sure = r
            .rows
            .iter()
            .all(|row| row.judgement.verdict == Verdict::Unique);
        assert!(
            !(sure && r.wrench.verdict == Verdict::NotUnique),
            "`{}`: all rows unique, the wrench not",
            r.name
        );
        assert!(
            !(free && r.multipliers.verdict == Verdict::Unique),
            "`{}`: a row is free, the multipliers unique",
            r.name
        );
        let component_free = r
            .components
            .iter()
            .any(|c| c.judgement.verdict == Verdict::NotUnique);
        assert!(
            !(component_free && r.wrench.verdict == Verdict::Unique),
            "`{}`: a component is free, the wrench unique",
            r.name
        );
    }
}

/// Checks that the document of `analyze --json` is JSON.
fn document(configuration: &ConfigurationAnalysis<'_>) {
    let generic = configuration.generic();
    let (name, analysis) = (configuration.scene.name(), &configuration.analysis);
    let mut document = AnalysisDocument::new(name, analysis, generic.as_ref());
    match configuration.explanation() {
        Ok(Some(explanation)) => document.explain(&explanation, configuration.mechanism.layout()),
        Ok(None) => {}
        Err(e) => named(&e),
    }
    if let Some(generic) = &generic
        && let Err(e) = configuration.continuation(generic)
    {
        named(&e);
    }
    let mut text = Vec::new();
    write_json(&mut text, &document).expect("a vector takes everything");
    let read: Result<serde_json::Value, _> = serde_json::from_slice(&text);
    assert!(read.is_ok_and(|d| d.is_object()), "no JSON document");
}
