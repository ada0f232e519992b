//! What a motion needs of the rows: which are independent, of C and of Φq alone, and whether the others agree with them. Small mechanisms are
//! decided as a whole, large ones part by part.

use linalg::{KeptRowsError, NearlyRedundant, RankDecision, RankStatus, SparseRank};
use model::{Mechanism, Part, Scratch, System};
use rayon::prelude::*;

use crate::certificate::inseparable;
use crate::existence::{Contradiction, Ranks, contradictions};
use crate::large::{SPARSE_FROM, decide_range};
use crate::mechanism::{AnalysisError, decide, decide_dropping, decide_holonomic, evaluated};
use crate::state::StateError;
use crate::survey::{LARGE, parts};

/// Rank and rows to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct RowDecision {
    /// r
    pub rank: usize,
    /// p
    pub redundancy: usize,
    /// r independent rows, ascending.
    pub kept: Vec<usize>,
    /// The others, ascending.
    pub dropped: Vec<usize>,
    /// Decided, or why not.
    pub status: RankStatus,
    /// Largest coefficient of a dependency that counts as zero.
    pub support_tolerance: f64,
}

impl RowDecision {
    /// Whether the rank is decided.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.status == RankStatus::Decided
    }

    /// Of nothing.
    fn empty() -> Self {
        Self {
            rank: 0,
            redundancy: 0,
            kept: Vec::new(),
            dropped: Vec::new(),
            status: RankStatus::Decided,
            support_tolerance: 0.0,
        }
    }

    /// Adds the decision of a part with these rows of the whole.
    fn add(&mut self, part: &Self, rows: &[usize]) {
        self.rank += part.rank;
        self.redundancy += part.redundancy;
        self.kept.extend(part.kept.iter().map(|&k| rows[k]));
        self.dropped.extend(part.dropped.iter().map(|&k| rows[k]));
        if self.is_decided() {
            self.status = part.status;
        }
        self.support_tolerance = self.support_tolerance.max(part.support_tolerance);
    }

    fn sorted(mut self) -> Self {
        self.kept.sort_unstable();
        self.dropped.sort_unstable();
        self
    }
}

impl From<&RankDecision> for RowDecision {
    fn from(decision: &RankDecision) -> Self {
        Self {
            rank: decision.rank,
            redundancy: decision.redundancy,
            kept: decision.kept.clone(),
            dropped: decision.dropped.clone(),
            status: decision.status,
            support_tolerance: linalg::support_tolerance(decision),
        }
    }
}

impl From<&SparseRank> for RowDecision {
    fn from(found: &SparseRank) -> Self {
        Self {
            rank: found.rank,
            redundancy: found.redundancy,
            kept: found.kept.clone(),
            dropped: found.dropped.clone(),
            status: found.status,
            support_tolerance: found.noise(),
        }
    }
}

/// Rows of C, and of Φq alone, at one configuration, with what the questions after them need.
pub struct Rows {
    /// Of all rows of C.
    pub all: RowDecision,
    /// Of the rows of Φq alone.
    pub holonomic: RowDecision,
    pieces: Vec<Piece>,
}

/// The whole or a part, and its decisions.
struct Piece {
    /// Nothing for the whole.
    part: Option<Part>,
    all: RowDecision,
    holonomic: RowDecision,
    /// The dense decisions, where it is not too large for them.
    dense: Option<[RankDecision; 2]>,
}

impl Piece {
    fn of_part(
        mechanism: &Mechanism,
        groups: &[usize],
        t: f64,
        q: &[f64],
    ) -> Result<Self, AnalysisError> {
        let part = mechanism.part_of_groups(groups);
        let own = own(q, &part.places.coordinates);
        let s = evaluated(&part.mechanism, t, &own);
        Self::of(&part.mechanism, &s, &own).map(|piece| Self {
            part: Some(part),
            ..piece
        })
    }

    /// Of the whole.
    fn of(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> Result<Self, AnalysisError> {
        let layout = mechanism.layout();
        if layout.rows() > SPARSE_FROM {
            let all = decide_range(mechanism, s, q, 0..layout.rows())?;
            let holonomic = match layout.h {
                0 => (&all).into(),
                _ => (&decide_range(mechanism, s, q, 0..layout.m)?).into(),
            };
            return Ok(Self {
                part: None,
                all: (&all).into(),
                holonomic,
                dense: None,
            });
        }
        let dense = [decide(mechanism, s, q)?, decide_holonomic(mechanism, s, q)?];
        Ok(Self {
            part: None,
            all: (&dense[0]).into(),
            holonomic: (&dense[1]).into(),
            dense: Some(dense),
        })
    }
}

fn own(x: &[f64], places: &[usize]) -> Vec<f64> {
    places.iter().map(|&j| x[j]).collect()
}

/// Decides at the pose of the scratch, where Φ and C have been evaluated at coordinates q.
///
/// # Errors
/// If C is not finite.
pub fn rows(mechanism: &Mechanism, s: &Scratch, q: &[f64]) -> Result<Rows, AnalysisError> {
    if mechanism.layout().rows() <= LARGE {
        let dense = [decide(mechanism, s, q)?, decide_holonomic(mechanism, s, q)?];
        let [all, holonomic] = [&dense[0], &dense[1]].map(RowDecision::from);
        let piece = Piece {
            part: None,
            all: all.clone(),
            holonomic: holonomic.clone(),
            dense: Some(dense),
        };
        return Ok(Rows {
            all,
            holonomic,
            pieces: vec![piece],
        });
    }
    let pieces = parts(mechanism, s);
    let pieces = pieces
        .par_iter()
        .map(|groups| Piece::of_part(mechanism, groups, s.t, q));
    // The first error by order of the parts, whoever was quicker.
    let pieces: Vec<Result<Piece, AnalysisError>> = pieces.collect();
    let pieces: Vec<Piece> = pieces.into_iter().collect::<Result<_, _>>()?;
    let sum = |of: fn(&Piece) -> &RowDecision| {
        let mut sum = RowDecision::empty();
        for piece in &pieces {
            if let Some(part) = &piece.part {
                sum.add(of(piece), &part.places.rows);
            }
        }
        sum.sorted()
    };
    Ok(Rows {
        all: sum(|piece| &piece.all),
        holonomic: sum(|piece| &piece.holonomic),
        pieces,
    })
}

/// Rank and rows of C alone, at the pose of the scratch.
///
/// # Errors
/// If C is not finite.
pub fn decide_rows(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RowDecision, AnalysisError> {
    of_pieces(mechanism, s, q, |piece, s, q, places| {
        match places.is_some() && piece.layout().rows() > SPARSE_FROM {
            true => Ok((&decide_range(piece, s, q, 0..piece.layout().rows())?).into()),
            false => Ok((&decide(piece, s, q)?).into()),
        }
    })
}

/// Rank and rows of Φq alone.
///
/// # Errors
/// If C is not finite.
pub fn decide_holonomic_rows(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
) -> Result<RowDecision, AnalysisError> {
    of_pieces(mechanism, s, q, |piece, s, q, places| {
        match places.is_some() && piece.layout().rows() > SPARSE_FROM {
            true => Ok((&decide_range(piece, s, q, 0..piece.layout().m)?).into()),
            false => Ok((&decide_holonomic(piece, s, q)?).into()),
        }
    })
}

/// Rank and rows of C with the dropped rows given, from 0.
///
/// # Errors
/// As [`decide_dropping`].
pub fn decide_rows_dropping(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    dropped: &[usize],
) -> Result<RowDecision, KeptRowsError> {
    let rows = mechanism.layout().rows();
    if let Some(&row) = dropped.iter().find(|&&row| row >= rows) {
        return Err(KeptRowsError::RowOutOfRange { row, rows });
    }
    of_pieces(mechanism, s, q, |piece, s, q, places| {
        let Some(places) = places else {
            return Ok((&decide_dropping(piece, s, q, dropped)?).into());
        };
        let own = dropped
            .iter()
            .filter_map(|row| places.binary_search(row).ok());
        let found = decide_dropping(piece, s, q, &own.collect::<Vec<_>>());
        found.map(|d| (&d).into()).map_err(|e| match e {
            KeptRowsError::Duplicate { row } => KeptRowsError::Duplicate { row: places[row] },
            other => other,
        })
    })
}

/// Adds up what is decided of the whole, or of each part; `decide` gets its mechanism, scratch, coordinates, and its rows among those of the whole.
fn of_pieces<E: Send>(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    decide: impl Fn(&Mechanism, &Scratch, &[f64], Option<&[usize]>) -> Result<RowDecision, E> + Sync,
) -> Result<RowDecision, E> {
    if mechanism.layout().rows() <= LARGE {
        return decide(mechanism, s, q, None);
    }
    let pieces = parts(mechanism, s);
    let pieces = pieces.par_iter().map(|groups| {
        let Part { mechanism, places } = mechanism.part_of_groups(groups);
        let own_q = own(q, &places.coordinates);
        let own_s = evaluated(&mechanism, s.t, &own_q);
        let decision = decide(&mechanism, &own_s, &own_q, Some(&places.rows));
        (decision, places.rows)
    });
    let mut sum = RowDecision::empty();
    for (decision, rows) in pieces.collect::<Vec<_>>() {
        sum.add(&decision?, &rows);
    }
    Ok(sum.sorted())
}

impl Rows {
    /// Kept rows that cannot be told from dependent ones in `f64`; directions are those of all rows. See [`inseparable`].
    #[must_use]
    pub fn inseparable(
        &self,
        mechanism: &Mechanism,
        s: &Scratch,
        q: &[f64],
    ) -> Option<NearlyRedundant> {
        self.pieces.iter().find_map(|piece| match &piece.part {
            None => inseparable(mechanism, s, q, &piece.dense.as_ref()?[0]),
            Some(part) => {
                let own_q = own(q, &part.places.coordinates);
                let own_s = evaluated(&part.mechanism, s.t, &own_q);
                let mut found =
                    inseparable(&part.mechanism, &own_s, &own_q, &piece.dense.as_ref()?[0])?;
                let mut direction = vec![0.0; mechanism.layout().rows()];
                for (&row, x) in part.places.rows.iter().zip(&found.direction) {
                    direction[row] = *x;
                }
                found.direction = direction;
                Some(found)
            }
        })
    }

    /// Redundant rows that cannot hold together, the worst of a part first. See [`contradictions`].
    ///
    /// # Errors
    /// As [`contradictions`].
    pub fn contradictions(
        &self,
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<Vec<Contradiction>, StateError> {
        let mut all = Vec::new();
        for piece in &self.pieces {
            // The rows of larger ones are compared by the monitors of the motion.
            let Some([decided, holonomic]) = &piece.dense else {
                continue;
            };
            let ranks = Ranks {
                all: decided,
                holonomic,
            };
            all.extend(match &piece.part {
                None => contradictions(mechanism, t, q, v, ranks)?,
                Some(_) if piece.all.redundancy == 0 && piece.holonomic.redundancy == 0 => continue,
                Some(part) => {
                    let [own_q, own_v] = [
                        own(q, &part.places.coordinates),
                        own(v, &part.places.velocities),
                    ];
                    contradictions(&part.mechanism, t, &own_q, &own_v, ranks)?
                }
            });
        }
        Ok(all)
    }
}
