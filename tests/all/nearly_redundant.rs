//! The third of three parallel cranks is misaligned by ε, from 1e-3 to 1e-20. In exact arithmetic
//! the rank is full for every ε, with reactions of size 1/ε. The program finds this until ε is less
//! than the uncertainty of the data. No result for any ε may be wrong.

use dynamics::{MotionError, RowChoice, prepare};
use exact::Exact;
use linalg::Matrix;
use model::{BodyRef, Mechanism, StartOptions, System};
use rank::Grounds;
use solvability::{Analysis, Verdict, analyse};
use tests::cranks;

use crate::plain::Plain;

/// Limit of some thousand rounding errors of values of size one: σ₁₂ is about ε/10, and the noise
/// of 12 × 12 entries about 10⁻¹⁴. Above this limit no misalignment may count as rounding.
const ROUNDING: f64 = 1e-12;

/// Number of misalignments that may be undecided if the rank is certified: between the uncertainty
/// of the data and four times this value.
const UNDECIDED: usize = 2;

fn misaligned(error: f64) -> Mechanism {
    Mechanism::build(&cranks::misaligned(error)).expect("the cranks build")
}

/// Returns C of the mechanism at the configuration given in its description.
fn constraint_matrix(mechanism: &Mechanism) -> Matrix {
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    assert!(s.phi.iter().all(|phi| *phi == 0.0), "{:?}", s.phi);
    mechanism.c(&mut s);
    mechanism.layout().dense(&s)
}

fn exact_rank(c: &Matrix) -> usize {
    let rows: Vec<&[f64]> = (0..c.nrows()).map(|i| c.row(i)).collect();
    Exact::of(&rows).rank()
}

fn analysed(mechanism: &Mechanism) -> Analysis {
    let (q, _) = mechanism.described_state();
    analyse(mechanism, 0.0, &q).expect("C is finite")
}

/// Returns 1e-3, 3e-4, … 1e-20.
fn misalignments() -> impl Iterator<Item = f64> {
    (3..=20).flat_map(|k| [10_f64.powi(-k), 3.0 * 10_f64.powi(-k - 1)])
}

/// The exact reference: with a misalignment of 10⁻²⁰, or of 10⁻³⁰⁰, the matrix has full rank;
/// without a misalignment it has not.
#[test]
fn the_matrix_holds_the_misalignment() {
    for error in misalignments().chain([1e-100, 1e-300]) {
        assert_eq!(
            exact_rank(&constraint_matrix(&misaligned(error))),
            12,
            "ε = {error:e}"
        );
    }
    assert_eq!(exact_rank(&constraint_matrix(&misaligned(0.0))), 11);
}

/// A plain matrix is taken as exact.
#[test]
fn plain_matrices_have_full_rank_for_any_misalignment() {
    for error in misalignments().chain([1e-100, 1e-300]) {
        let c = constraint_matrix(&misaligned(error));
        let s = Plain::of(&c);
        assert!(s.decision().is_decided(), "ε = {error:e}");
        assert_eq!(s.decision().rank, 12, "ε = {error:e}");
        assert!(
            (0..12).all(|i| s.row(i).verdict.is_unique()),
            "ε = {error:e}"
        );
    }
    let s = Plain::of(&constraint_matrix(&misaligned(0.0)));
    assert_eq!(s.decision().rank, 11);
    // In vertical cranks, forces along them are not unique, and forces across them are unique.
    let found: Vec<bool> = (0..12).map(|i| s.row(i).verdict.is_unique()).collect();
    assert_eq!(found, [true, false].repeat(6));
}

/// The result of the program for a mechanism: redundant, of full rank, or undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Said {
    Redundant,
    FullRank,
    Undecided,
}

fn said(analysis: &Analysis) -> Said {
    match analysis.decision.redundancy {
        _ if !analysis.decision.is_decided() => Said::Undecided,
        0 => Said::FullRank,
        _ => Said::Redundant,
    }
}

/// The data of a mechanism are at best accurate to their rounding: only within this accuracy may
/// the program call a misaligned crank redundant.
#[test]
fn mechanisms_are_redundant_only_within_what_their_data_are_known_to() {
    let (mut before, mut undecided) = (Said::FullRank, 0);
    for error in misalignments() {
        let analysis = analysed(&misaligned(error));
        let found = said(&analysis);
        match found {
            Said::FullRank => assert!(
                analysis
                    .reactions
                    .iter()
                    .all(|r| r.wrench.verdict.is_unique())
            ),
            Said::Redundant => {
                assert!(error < ROUNDING, "ε = {error:e} is no rounding");
                assert_eq!(analysis.decision.redundancy, 1);
                assert!(
                    analysis
                        .reactions
                        .iter()
                        .all(|r| r.wrench.verdict == Verdict::NotUnique)
                );
            }
            Said::Undecided => {
                undecided += 1;
                assert!(
                    analysis
                        .reactions
                        .iter()
                        .all(|r| !r.wrench.verdict.is_unique())
                );
            }
        }
        check_certificate(&analysis, found, error);
        if error >= 1e-6 {
            assert_eq!(found, Said::FullRank, "ε = {error:e}");
        }
        if error <= 1e-17 {
            assert_eq!(found, Said::Redundant, "ε = {error:e}");
        }
        // For decreasing ε the results are full rank, undecided, redundant.
        let order = |said: Said| {
            [Said::FullRank, Said::Undecided, Said::Redundant]
                .iter()
                .position(|s| *s == said)
        };
        assert!(
            order(found) >= order(before),
            "ε = {error:e}: {found:?} after {before:?}"
        );
        before = found;
    }
    let aligned = analysed(&misaligned(0.0));
    assert_eq!(said(&aligned), Said::Redundant);
    assert_eq!(aligned.decision.rank, 11);
    if let Some(certificate) = &aligned.evidence().certificate {
        assert_eq!(certificate.grounds, Grounds::Vanishes);
        assert!(undecided <= UNDECIDED, "{undecided} undecided");
    }
}

/// The required content of a certified rank: the reason why a misaligned crank is redundant, and
/// the size of the reactions if it is not.
fn check_certificate(analysis: &Analysis, found: Said, error: f64) {
    let decision = analysis.whole().expect("one part");
    let Some(certificate) = &decision.evidence.certificate else {
        return;
    };
    match found {
        Said::Redundant => assert_eq!(certificate.grounds, Grounds::WithinData, "ε = {error:e}"),
        Said::FullRank => {
            assert_eq!(certificate.grounds, Grounds::FullRank, "ε = {error:e}");
            // The proof needs ten times more margin than the decision.
            assert!(
                certificate.rank_at_least == 12 || error < 1e-11,
                "ε = {error:e}"
            );
            // The singular value σ₁₂ is about ε/10.
            let near = decision.nearly_redundant();
            assert!(near.is_some() || error > 1e-6, "ε = {error:e}");
            if let Some(near) = near {
                assert!((0.01..1.0).contains(&(near.sigma / error)), "{near:?}");
            }
        }
        Said::Undecided => {}
    }
}

/// Vertical cranks at 0, 1 and 1.7 push against their coupler with 0.7, −1.7 and 1, each through
/// two joints. Rows across them, and rows of a separate pendulum, do not take part.
#[test]
fn a_start_names_the_rows_that_nearly_depend_and_no_others() {
    let mut d = cranks::misaligned(1e-9);
    let pendulum = BodyRef::Body(d.bodies.len());
    d.bodies
        .push(tests::rod("pendulum", 1.0, [5.0, 0.0], [5.0, -1.0]));
    let pair = [BodyRef::Ground, pendulum];
    d.joints
        .push(tests::revolute("hinge", &d.bodies, pair, [5.0, 0.0]));
    let mechanism = Mechanism::build(&d).expect("builds");
    let refused = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
    let Err(MotionError::Inseparable { rows, sigma, .. }) = refused else {
        panic!("{:?}", refused.err());
    };
    assert!(sigma < 1e-9, "{sigma}");
    assert_eq!(rows.len(), 6, "{rows:?}");
    assert!(rows.iter().all(|row| !row.contains("hinge")), "{rows:?}");
}
