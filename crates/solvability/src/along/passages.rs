//! Finds the instants at which the rank drops or nearly drops.

use crate::limits::{
    BENT, BESIDE_PASSAGE, MAY_PASS, MINIMUM_LOWER, OVERLAP, SAMPLE_HALVINGS, SINGULAR_INSTANT,
};
use crate::pose::velocity_units;
use linalg::{Matrix, PivotedQr, least_squares_step};
use model::{Mechanism, System, is_at_rest};
use rank::{RankDecision, RankStatus};

use super::border::Border;
use rank::NEARLY_REDUNDANT;

use super::data::{AlongError, Passage, PassageKind, Stretch};
use super::path::{Path, Point, Sample, singular_value};
use super::search;
use crate::second_order::{Continuation, SecondOrderDoubt, second_order};
use crate::state::State;

/// An instant at which σ_r has a minimum.
#[derive(Clone, Copy)]
struct SigmaMinimum {
    t: f64,
    sigma: f64,
    /// Whether a sign change proves that σ_r is zero at this instant.
    proved: bool,
}

/// A singular or nearly singular instant, with its rank.
pub(super) struct DecidedPassage {
    /// The instant, without compared verdicts.
    pub(super) passage: Passage,
    pub(super) point: Point,
    pub(super) decision: RankDecision,
}

/// Finds singular and nearly singular instants. Time intervals that are singular throughout are
/// excluded.
pub(super) fn passages<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    stretches: &[Stretch],
) -> Result<Vec<DecidedPassage>, AlongError> {
    let mut found = sign_changes(path)?;
    let times: Vec<f64> = path.samples.iter().map(|s| s.t).collect();
    let sigma: Vec<Option<f64>> = path.samples.iter().map(|s| Some(s.sigma)).collect();
    for bracket in local_minima(&times, &sigma) {
        let [a, b] = bracket;
        if found.iter().any(|c| a <= c.t && c.t <= b) {
            continue;
        }
        let least = search::minimum(bracket, NEARLY_REDUNDANT, 0.0, |t| path.sigma(t))?;
        if let Some((t, sigma)) = least
            && sigma < NEARLY_REDUNDANT
        {
            let proved = false;
            found.push(SigmaMinimum { t, sigma, proved });
        }
    }
    let redundancy = path.mechanism.layout().rows() - path.rank;
    let is_apart = |c: &SigmaMinimum| {
        let mut singular = stretches.iter().filter(|s| s.redundancy > redundancy);
        singular.all(|s| !(s.from..=s.to).contains(&c.t))
    };
    found.retain(is_apart);
    found
        .into_iter()
        .map(|candidate| passage(path, candidate))
        .collect()
}

/// Returns brackets of the minima of a sampled function, including minima at its ends. The function
/// returns no bracket on intervals on which the values are constant. The function also returns no
/// bracket next to times with unknown values, because the values may decrease further towards these
/// times.
pub(super) fn local_minima(times: &[f64], values: &[Option<f64>]) -> Vec<[f64; 2]> {
    let last = times.len().saturating_sub(1);
    (0..times.len())
        .filter_map(|k| {
            let (first, last) = (k.saturating_sub(1), last.min(k + 1));
            let (before, here, after) = (values[first]?, values[k]?, values[last]?);
            let lowest = here <= before && here <= after;
            let falls = here < MINIMUM_LOWER * before.max(after);
            (lowest && falls).then(|| [times[first], times[last]])
        })
        .collect()
}

/// An end of an interval.
#[derive(Clone)]
struct End {
    t: f64,
    /// Singular value σ_r.
    sigma: f64,
    /// C, equilibrated with the scaling of all samples.
    matrix: Matrix,
    kept: Vec<usize>,
}

/// Returns the Frobenius norm of a difference.
fn distance(a: &Matrix, b: &Matrix) -> f64 {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Finds roots of the bordered determinant between regular samples.
fn sign_changes<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
) -> Result<Vec<SigmaMinimum>, AlongError> {
    let ends: Vec<End> = path
        .samples
        .iter()
        .filter(|s| s.regular)
        .map(|s| End {
            t: s.t,
            sigma: s.sigma,
            matrix: s.c.clone(),
            kept: s.decision.kept.clone(),
        })
        .collect();
    let mut found: Vec<SigmaMinimum> = Vec::new();
    let mut intervals: Vec<(End, End, usize)> = ends
        .windows(2)
        .map(|w| (w[0].clone(), w[1].clone(), SAMPLE_HALVINGS))
        .collect();
    while let Some((a, b, halvings)) = intervals.pop() {
        // If the distance of C from a matrix of rank r is at most this distance, the rank of C is
        // at least r.
        if BENT * distance(&a.matrix, &b.matrix) < a.sigma.max(b.sigma) {
            continue;
        }
        let mut border = Border::new(&a.matrix, &a.kept);
        let value = border.value(&b.matrix);
        if value < 0.0 {
            let at = |t: f64| -> Result<f64, AlongError> {
                let point = path.at(t)?;
                Ok(border.value(&path.equilibrated(&point)))
            };
            let t = search::root([a.t, b.t], [1.0, value], 0.0, at)?;
            let sigma = path.sigma(t)?;
            if sigma < SINGULAR_INSTANT {
                let proved = true;
                found.push(SigmaMinimum { t, sigma, proved });
                continue;
            }
        }
        if halvings == 0 {
            continue;
        }
        // The same test in the other direction, with the rows and the frame of b.
        let mut back = Border::new(&b.matrix, &b.kept);
        let overlaps = |border: &Border, back: &Border| {
            let there = border.overlap(back, &b.matrix);
            there.min(back.overlap(border, &a.matrix))
        };
        let doubtful = value < MAY_PASS
            || back.value(&a.matrix) < MAY_PASS
            || overlaps(&border, &back) < OVERLAP;
        if doubtful {
            let t = 0.5 * (a.t + b.t);
            let point = path.at(t)?;
            let decision = path.decide(&point, 0.0)?;
            if decision.is_decided() && decision.rank == path.rank {
                let matrix = path.equilibrated(&point);
                let middle = End {
                    t,
                    sigma: singular_value(&matrix, path.rank),
                    matrix,
                    kept: decision.kept,
                };
                intervals.push((a, middle.clone(), halvings - 1));
                intervals.push((middle, b, halvings - 1));
            }
        }
    }
    Ok(found)
}

/// Determines the event at a candidate.
fn passage<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    candidate: SigmaMinimum,
) -> Result<DecidedPassage, AlongError> {
    let (time, sigma) = (candidate.t, candidate.sigma);
    let point = path.at(time)?;
    // A sign change proves that the distance to a matrix of lower rank is at most σ_r.
    let distance = if candidate.proved { sigma } else { 0.0 };
    let decision = path.decide(&point, distance)?;
    let interval = nearly_singular(path, time)?;
    let kind = match decision.status {
        RankStatus::Undecided(doubt) => PassageKind::Undecided { doubt },
        _ if decision.rank == path.rank => PassageKind::NearlySingular { sigma },
        _ => {
            let continuation = match consistent(path.mechanism, &point, &decision.kept) {
                Some(v) => {
                    let regular = regular_motions(path, time, interval, &v)?;
                    second_order(path.mechanism, time, &point.q, &v, &decision, &regular)?
                }
                None => Continuation::Undetermined(SecondOrderDoubt::Open),
            };
            PassageKind::RankDrops {
                redundancy: decision.redundancy,
                continuation,
            }
        }
    };
    let passage = Passage {
        time,
        kind,
        nearly_singular: interval,
        differences: Vec::new(),
        text: String::new(),
    };
    Ok(DecidedPassage {
        passage,
        point,
        decision,
    })
}

/// Returns the interval around t on which σ_r is below the limit, within the time range of the
/// motion.
fn nearly_singular<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    t: f64,
) -> Result<[f64; 2], AlongError> {
    let samples = &path.samples;
    let ends = [samples[0].t, samples[samples.len() - 1].t];
    let before: Vec<&Sample> = samples.iter().rev().filter(|s| s.t < t).collect();
    let after: Vec<&Sample> = samples.iter().filter(|s| s.t > t).collect();
    // The first sample outside the interval, and the last sample inside.
    let edges = [before, after].map(|side| {
        let outside = side.iter().position(|s| s.sigma >= NEARLY_REDUNDANT)?;
        let inside = outside.checked_sub(1).map_or(t, |k| side[k].t);
        Some([side[outside].t, inside])
    });
    let mut found = ends;
    for (found, edge) in found.iter_mut().zip(edges) {
        if let Some(edge) = edge {
            *found = search::edge(edge, |t| {
                Ok::<_, AlongError>(path.sigma(t)? - NEARLY_REDUNDANT)
            })?;
        }
    }
    Ok(found)
}

/// Returns velocities of the motion that satisfy `C·v = b` in the kept rows. Returns `None` if
/// these rows are dependent to the last digit.
fn consistent(mechanism: &Mechanism, p: &Point, kept: &[usize]) -> Option<Vec<f64>> {
    let layout = mechanism.layout();
    let mut s = p.s.clone();
    mechanism.b(&mut s);
    let c = layout.dense(&s).select_rows(kept);
    let residual: Vec<f64> = kept
        .iter()
        .map(|&i| layout.velocity_residual(&s, i, &p.v))
        .collect();
    let weights = vec![1.0; p.v.len()];
    let step = least_squares_step(&c, &residual, &weights, 0.0).ok()?;
    Some(p.v.iter().zip(step).map(|(v, d)| v + d).collect())
}

/// Returns the free velocities just before and after the instant, n_v × (n_v − r).
fn regular_motions<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    t: f64,
    [from, to]: [f64; 2],
    v: &[f64],
) -> Result<Matrix, AlongError> {
    let n = v.len();
    let freedoms = n - path.rank;
    let moves = !is_at_rest(path.mechanism, path.size(), v);
    if freedoms == 1 && moves && !path.mechanism.layout().rheonomic {
        return Ok(Matrix::from_fn(n, 1, |i, _| v[i]));
    }
    if freedoms == 0 {
        return Ok(Matrix::zeros(n, 0));
    }
    // The mean of both sides differs from the limit only by the square of the distance of the
    // sides.
    let distance = BESIDE_PASSAGE * (to - t).min(t - from);
    let sides = if distance > 0.0 {
        vec![t - distance, t + distance]
    } else if to > t {
        vec![t + BESIDE_PASSAGE * (to - t)]
    } else {
        vec![t + BESIDE_PASSAGE * (from - t)]
    };
    let mut frames = Vec::new();
    for t in sides {
        let point = path.at(t)?;
        let kept = path.decide(&point, 0.0)?.kept;
        let rows = point.c.select_rows(&kept[..path.rank.min(kept.len())]);
        frames.push(PivotedQr::of_rows(rows).q_columns(n - freedoms..n));
    }
    let first = &frames[0];
    let mut sum = first.clone();
    for other in &frames[1..] {
        // The second frame, rotated onto the first frame.
        let turned = other.product(&other.transpose().product(first));
        let entries = sum.as_mut_slice().iter_mut().zip(turned.as_slice());
        entries.for_each(|(sum, x)| *sum += x);
    }
    let units = velocity_units(path.mechanism, path.size());
    Ok(Matrix::from_fn(n, freedoms, |i, j| sum[(i, j)] * units[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    use joints::{Line, PointOnLine, Revolute};
    use model::{Body, BodyRef, Description};

    #[test]
    fn a_minimum_lies_a_hundredth_below_a_neighbour() {
        for (least, expected) in [(0.994, vec![]), (0.986, vec![[0.0, 2.0]])] {
            let values = [Some(1.0), Some(least), Some(least)];
            let found = local_minima(&[0.0, 1.0, 2.0], &values);
            assert_eq!(found, expected, "{least}");
        }
    }

    /// Returns a crank of one metre on a rod of one metre, whose end slides on the x axis. If the
    /// crank is at 90° + δ, the end is at −2·sin δ. The rows lose their rank where δ passes zero.
    fn passed(delta: impl Fn(f64) -> f64, times: &[f64]) -> Vec<f64> {
        let mut d = Description::new("slider-crank");
        let crank = d.body(Body::new("crank", 1.0, 1.0));
        let rod = d.body(Body::new("rod", 1.0, 1.0));
        let pin = |s_i: [f64; 2], s_j: [f64; 2]| Revolute { s_i, s_j };
        d.joint("A", &[BodyRef::Ground, crank], pin([0.0; 2], [-0.5, 0.0]));
        d.joint("B", &[crank, rod], pin([0.5, 0.0], [-0.5, 0.0]));
        let line = Line::new([0.0; 2], [1.0, 0.0]).expect("a line");
        d.joint(
            "C",
            &[rod],
            PointOnLine {
                s: [0.5, 0.0],
                line,
            },
        );
        let mechanism = Mechanism::build(&d).expect("builds");
        let motion = |t: f64| {
            let angle = FRAC_PI_2 + delta(t);
            let (s, c) = angle.sin_cos();
            let q = vec![0.5 * c, 0.5 * s, angle, 1.5 * c, 0.5 * s, -angle];
            let h = 1e-6;
            let rate = (delta(t + h) - delta(t - h)) / (2.0 * h);
            let v = vec![
                -0.5 * s * rate,
                0.5 * c * rate,
                rate,
                -1.5 * s * rate,
                0.5 * c * rate,
                -rate,
            ];
            State { q, v }
        };
        let found = crate::along::singular_passages(&mechanism, motion, times).expect("a motion");
        let mut times: Vec<f64> = found.iter().map(|passage| passage.time).collect();
        times.sort_by(f64::total_cmp);
        times
    }

    const SAMPLES: [f64; 3] = [0.0, 0.5, 1.0];

    /// A function that rises from 0 to 1 between the second and the third sample.
    fn second_half(t: f64) -> f64 {
        (2.0 * t - 1.0).max(0.0)
    }

    fn are_near(found: &[f64], expected: &[f64]) {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6;
        let all = found.len() == expected.len() && found.iter().zip(expected).all(near);
        assert!(all, "{found:?} for {expected:?}");
    }

    /// δ = 1.2·(t − 0.7)·(t − 0.99) has the same sign at all three samples.
    #[test]
    fn two_passages_between_samples_show_in_a_small_determinant() {
        let found = passed(|t| 1.2 * (t - 0.7) * (t - 0.99), &SAMPLES);
        are_near(&found, &[0.7, 0.99]);
    }

    /// A revolution through both singular configurations, δ = 0 and δ = π, ends with determinants
    /// of the same size and sign. The bodies move in other directions at its end.
    #[test]
    fn two_passages_between_samples_show_in_a_turned_motion() {
        let (from, turn) = (-1.1, PI + 2.2);
        let found = passed(|t| from + turn * second_half(t), &SAMPLES);
        are_near(
            &found,
            &[-from, PI - from].map(|way| 0.5 + 0.5 * way / turn),
        );
    }

    /// δ is 0.5 until it falls below zero for two thousandths of the motion. Afterwards δ is 0.02.
    #[test]
    fn passages_are_found_that_are_two_thousandths_apart() {
        let roots = [0.3095, 0.3115];
        let delta = |t: f64| {
            let steep = |from: f64| (8000.0 * (t - from)).tanh();
            steep(roots[0]) * steep(roots[1]) * (0.26 - 0.24 * steep(0.3105))
        };
        are_near(&passed(delta, &SAMPLES), &roots);
    }

    /// All samples are equally nearly singular, and all are used.
    #[test]
    fn a_motion_near_a_singular_pose_has_regular_samples() {
        let found = passed(|t| 2e-4 * (1.0 - 2.0 * second_half(t)), &SAMPLES);
        are_near(&found, &[0.75]);
    }
}
