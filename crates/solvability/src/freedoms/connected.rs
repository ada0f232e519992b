//! Sets of bodies connected by joints. Each set has its own rank and is described separately.

use crate::limits::{AT_REST, MOTIONS_REPORTED, ROWS_MAX, SATISFIED};
use crate::pose::velocity_units;
use linalg::Matrix;
use model::start::scene_size;
use model::{Bodies, Mechanism, Part, System};

use super::component::{Component, Velocities, shared_rank};
use super::movement::Twist;
use super::{FreeMotion, FreeMotions, LeftOut, PartRank, words};

/// The motions described so far.
#[derive(Default)]
struct DescribedMotions {
    motions: Vec<FreeMotion>,
    freedoms: usize,
    too_large: usize,
}

/// A mechanism with some of its joints, and the sets of bodies that these joints connect.
pub(super) struct ConnectedSets<'a> {
    whole: &'a Mechanism,
    joined: Part,
    /// Bodies of the whole mechanism, ascending. A body without joints is a separate set.
    sets: Vec<Vec<usize>>,
}

impl<'a> ConnectedSets<'a> {
    /// Creates the sets that all joints connect, with or without the drives.
    pub(super) fn new(whole: &'a Mechanism, drives: bool) -> Self {
        let groups = whole.layout().groups.iter().enumerate();
        let chosen = groups.filter(|(_, group)| drives || !group.is_drive());
        let chosen: Vec<usize> = chosen.map(|(k, _)| k).collect();
        let joined = whole.part_of_groups(&chosen);
        let sets = whole.joined(&chosen);
        Self {
            whole,
            joined,
            sets,
        }
    }

    /// Returns a basis of the velocities that the rows allow, if the ranks of the rows are known
    /// and their sum is less than n_v.
    pub(super) fn motions(&self, t: f64, q: &[f64], decided: &[PartRank]) -> FreeMotions {
        let rank: usize = decided.iter().map(|part| part.rank).sum();
        let mut described = DescribedMotions::default();
        for (set, rank) in self.sets.iter().zip(self.ranks(t, q, decided)) {
            match rank {
                Some(rank) => self.describe(set, t, q, rank, &mut described),
                None => described.too_large += 1,
            }
        }
        let freedoms = self
            .whole
            .layout()
            .n_v
            .saturating_sub(rank + described.freedoms);
        let reason = match described.too_large {
            0 => format!("the first {MOTIONS_REPORTED} motions are listed"),
            _ => format!("connected joints of more than {ROWS_MAX} rows are not taken apart"),
        };
        FreeMotions {
            motions: described.motions,
            left_out: (freedoms > 0).then_some(LeftOut { freedoms, reason }),
        }
    }

    /// Returns the rank of the rows of each set. The rank is `None` if the set is too large. The
    /// rank of the set then cannot be separated from that of other sets, or the set cannot be
    /// analysed further.
    fn ranks(&self, t: f64, q: &[f64], decided: &[PartRank]) -> Vec<Option<usize>> {
        let layout = self.whole.layout();
        let columns = self.whole.space().n_v();
        let mut set_of = vec![0; self.whole.bodies().len()];
        for (k, set) in self.sets.iter().enumerate() {
            set.iter().for_each(|&b| set_of[b] = k);
        }
        let mut set_of_row = vec![None; layout.rows()];
        let mut size = vec![0; self.sets.len()];
        for group in &layout.groups {
            let body = group.bodies.iter().find_map(|b| b.moving());
            for row in &group.rows {
                set_of_row[row] = body.map(|b| set_of[b]);
            }
        }
        let mut ranks: Vec<Option<usize>> = vec![Some(0); self.sets.len()];
        for part in decided {
            let mut own: Vec<(usize, Vec<usize>)> = Vec::new();
            for &row in &part.rows {
                // Rows between two parts of the ground do not add to any rank.
                let Some(set) = set_of_row[row] else {
                    continue;
                };
                size[set] += 1;
                match own.iter_mut().find(|(k, _)| *k == set) {
                    Some((_, rows)) => rows.push(row),
                    None => own.push((set, vec![row])),
                }
            }
            if let [(set, _)] = own.as_slice() {
                ranks[*set] = ranks[*set].map(|rank| rank + part.rank);
                continue;
            }
            let is_large = |set: usize, rows: &[usize]| {
                rows.len() > ROWS_MAX || columns * self.sets[set].len() > ROWS_MAX
            };
            let too_large = own.iter().any(|(set, rows)| is_large(*set, rows));
            let pivots = own.iter().map(|(set, rows)| {
                if too_large {
                    Vec::new()
                } else {
                    self.pivots(&self.sets[*set], t, q, rows)
                }
            });
            let pivots: Vec<Vec<f64>> = pivots.collect();
            for ((set, _), rank) in own.iter().zip(shared_rank(&pivots, part.rank)) {
                let known = ranks[*set].filter(|_| !too_large);
                ranks[*set] = known.map(|before| before + rank);
            }
        }
        for (k, rank) in ranks.iter_mut().enumerate() {
            if size[k] > ROWS_MAX || columns * self.sets[k].len() > ROWS_MAX {
                *rank = None;
            }
        }
        ranks
    }

    /// Returns the pivots of some rows of a set. The rows are numbered in the whole mechanism.
    fn pivots(&self, set: &[usize], t: f64, q: &[f64], rows: &[usize]) -> Vec<f64> {
        let part = self.part(set);
        let places = |row: &usize| {
            let row = self.joined.places.rows[*row];
            rows.contains(&row)
        };
        let own: Vec<usize> = (0..part.places.rows.len())
            .filter(|&k| places(&part.places.rows[k]))
            .collect();
        Component::new(&part.mechanism, t, &self.coordinates(&part, q)).pivots(&own)
    }

    /// Returns the coordinates of the part of a set, with the unwrapped angles of its joints.
    fn coordinates(&self, part: &Part, q: &[f64]) -> Vec<f64> {
        let of_whole = &self.joined.places.coordinates;
        let places = part.places.coordinates.iter();
        places.map(|&k| q[of_whole[k]]).collect()
    }

    /// Returns the mechanism of a set of connected bodies. The indices refer to the mechanism of
    /// the chosen joints.
    fn part(&self, set: &[usize]) -> Part {
        let bodies = &self.joined.places.bodies;
        let own = set.iter().filter_map(|b| bodies.binary_search(b).ok());
        self.joined.mechanism.part(&own.collect::<Vec<_>>())
    }

    /// Returns whether no joint acts on the bodies of a set.
    fn is_alone(&self, set: &[usize]) -> bool {
        let joined = &self.joined.places.bodies;
        set.iter().all(|b| joined.binary_search(b).is_err())
    }

    fn describe(
        &self,
        set: &[usize],
        t: f64,
        q: &[f64],
        rank: usize,
        described: &mut DescribedMotions,
    ) {
        let most = MOTIONS_REPORTED - described.motions.len().min(MOTIONS_REPORTED);
        let columns = self.whole.space().n_v();
        if most == 0 || rank == columns * set.len() {
            return;
        }
        if self.is_alone(set) {
            // Motions about the centre of mass, in ground axes.
            let ground = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let places = set.iter().flat_map(|&b| self.whole.space().coordinates(b));
            let own: Vec<f64> = places.map(|k| q[k]).collect();
            let poses = Bodies::at(self.whole.space(), &own);
            let unit = |k: usize, own: usize| {
                let motion = self.whole.space().rigid_motion(k, [0.0; 3], ground);
                self.of_frame(set[own], poses.turned(own, self.to_frame(set[own])), motion)
            };
            let bodies = || set.iter().copied().enumerate();
            let velocities =
                (0..columns).map(|k| bodies().map(|(own, b)| (b, unit(k, own))).collect());
            described.freedoms += columns;
            described.motions.push(FreeMotion {
                text: words::free(self.whole, set),
                velocities: velocities.collect(),
            });
            return;
        }
        let part = self.part(set);
        let component = Component::new(&part.mechanism, t, &self.coordinates(&part, q));
        let found = component.motions(rank, most);
        let numbered = |velocities| self.numbered(set, &component, velocities);
        if found.is_free {
            described.freedoms += columns;
            let velocities = component.rigid_velocities().into_iter();
            described.motions.push(FreeMotion {
                text: words::free(self.whole, set),
                velocities: velocities.map(numbered).collect(),
            });
        }
        let driven = self.driven(set);
        for motion in found.motions {
            if described.motions.len() == MOTIONS_REPORTED {
                return;
            }
            let (text, velocities) = words::tell(&component, &driven, motion);
            described.freedoms += 1;
            described.motions.push(FreeMotion {
                text,
                velocities: vec![numbered(velocities)],
            });
        }
    }

    /// Returns the moving bodies of a set with the velocities of their frames.
    fn numbered(
        &self,
        set: &[usize],
        component: &Component<'_>,
        velocities: Velocities,
    ) -> Vec<(usize, Vec<f64>)> {
        let bodies = set.iter().copied().zip(velocities).enumerate();
        let moving = bodies.filter(|(_, (_, v))| v.iter().any(|v| *v != 0.0));
        moving
            .map(|(own, (body, v))| {
                let arm = component.s.bodies.turned(own, self.to_frame(body));
                (body, self.of_frame(body, arm, v))
            })
            .collect()
    }

    /// Describes velocities (n_v values each) as motions of connected bodies. The motions span the
    /// velocities.
    pub(super) fn among(&self, t: f64, q: &[f64], velocities: &[Vec<f64>]) -> Vec<FreeMotion> {
        let units = velocity_units(self.whole, scene_size(self.whole, q));
        let scaled = |k: usize, j: usize| (velocities[k][j] / units[j]).abs();
        let largest = |columns: &[usize]| {
            let all = (0..velocities.len()).flat_map(|k| columns.iter().map(move |&j| (k, j)));
            all.fold(0.0, |largest: f64, (k, j)| largest.max(scaled(k, j)))
        };
        let fastest = largest(&(0..units.len()).collect::<Vec<_>>());
        let mut described = Vec::new();
        for set in &self.sets {
            let columns = set.iter().flat_map(|&b| self.whole.space().columns_of(b));
            let columns: Vec<usize> = columns.collect();
            let own = |k: usize, j: usize| velocities[k][columns[j]];
            let own = Matrix::from_fn(velocities.len(), columns.len(), own);
            let is_at_rest = largest(&columns) <= SATISFIED * fastest;
            if is_at_rest || self.is_alone(set) || columns.len() > ROWS_MAX {
                continue;
            }
            let part = self.part(set);
            let component = Component::new(&part.mechanism, t, &self.coordinates(&part, q));
            let driven = self.driven(set);
            let most = MOTIONS_REPORTED.saturating_sub(described.len());
            for motion in component.among(&own, most) {
                let (text, velocities) = words::tell(&component, &driven, motion);
                described.push(FreeMotion {
                    text,
                    velocities: vec![self.numbered(set, &component, velocities)],
                });
            }
        }
        described
    }

    /// Describes velocities (n_v values each) of bodies on which no joint acts.
    pub(super) fn alone(&self, q: &[f64], velocities: &[Vec<f64>]) -> Vec<FreeMotion> {
        let (space, frames) = (self.whole.space(), self.whole.frames());
        let size = scene_size(self.whole, q);
        let units = velocity_units(self.whole, size);
        let fastest = |v: &[f64], columns: std::ops::Range<usize>| {
            let shares = columns.map(|j| (v[j] / units[j]).abs());
            shares.fold(0.0, f64::max)
        };
        let mut described = Vec::new();
        for set in self.sets.iter().filter(|set| self.is_alone(set)) {
            let body = set[0];
            let moves = |v: &&Vec<f64>| {
                let own = fastest(v, space.columns_of(body));
                own > SATISFIED * fastest(v, 0..v.len())
            };
            let own: Vec<&Vec<f64>> = velocities.iter().filter(moves).collect();
            let is_free = own.len() == space.n_v();
            let mut told = Vec::new();
            let mut numbers = Vec::new();
            for v in own {
                let state = frames.body(body, q, v);
                let twist = Twist {
                    velocity: state.velocity,
                    omega: state.omega,
                };
                let movement = twist.movement(state.place, size);
                told.push(words::alone(self.whole, body, movement, size));
                numbers.push(vec![(body, twist.components(space))]);
            }
            if is_free {
                described.push(FreeMotion {
                    text: words::free(self.whole, set),
                    velocities: numbers,
                });
                continue;
            }
            let each = told.into_iter().zip(numbers);
            described.extend(each.map(|(text, numbers)| FreeMotion {
                text,
                velocities: vec![numbers],
            }));
        }
        described
    }

    /// Returns the vector from the centre of mass of a body to the origin of its frame, in body
    /// axes (m).
    fn to_frame(&self, body: usize) -> [f64; 3] {
        self.whole.bodies()[body].from_centre([0.0; 3])
    }

    /// Returns the velocities of the frame of a body. The velocities of its centre of mass are
    /// given, and `arm` is the vector from the centre of mass to the origin of the frame.
    fn of_frame(&self, body: usize, arm: [f64; 3], v: Vec<f64>) -> Vec<f64> {
        let space = self.whole.space();
        // In the plane, the velocities refer to the centre of mass.
        if space.n_rotations() == 1 || self.whole.bodies()[body].is_centred() {
            return v;
        }
        let centre = Twist::new(space, &v);
        let origin = centre.carried(arm);
        // The velocity of a point at rest is a sum with rounding errors.
        let largest = centre.speed(0.0).max(origin.less(centre).speed(0.0));
        let mut shown = origin.components(space);
        for k in space.forces() {
            if shown[k].abs() <= AT_REST * largest {
                shown[k] = 0.0;
            }
        }
        shown
    }

    /// Returns the bodies of a set on which a drive acts, as indices into the set.
    fn driven(&self, set: &[usize]) -> Vec<usize> {
        let groups = self.whole.layout().groups.iter();
        let drives = groups.filter(|group| group.is_drive());
        let bodies = drives.flat_map(|group| group.bodies.iter().filter_map(|b| b.moving()));
        bodies.filter_map(|b| set.binary_search(&b).ok()).collect()
    }
}
