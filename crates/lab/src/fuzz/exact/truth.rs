//! The results of exact arithmetic for a drawing.

use std::collections::BTreeSet;

use exact::Exact;
use num_bigint::BigInt;
use num_traits::{ToPrimitive, Zero};

use super::findings::rounding;
use super::pose::Posed;
use super::ratio::Ratio;
use super::reference::{Elsewhere, Ranks, Reference, RightReaction, RightWrench};
use super::rows::{self, Row};

/// A wrench on the first body of a joint, with components along the axes of the drawing and about
/// the place of the joint, times `common`.
#[derive(Clone, Debug)]
pub struct Reaction {
    force: [BigInt; 2],
    moment: BigInt,
    common: BigInt,
}

impl Reaction {
    /// Whether a component in the world is exactly zero.
    #[must_use]
    pub fn is_zero(&self, component: &str, posed: &Posed) -> bool {
        let [c, s] = posed.turn;
        let [x, y] = &self.force;
        // a·x + b·√k·y
        let vanishes = |a: Ratio, b: Ratio| match posed.stretch {
            1 => {
                let whole = |p: Ratio, q: Ratio| BigInt::from(p.numerator() * q.denominator());
                (whole(a, b) * x + whole(b, a) * y).is_zero()
            }
            _ => (a.is_zero() || x.is_zero()) && (b.is_zero() || y.is_zero()),
        };
        match component {
            "Fx" => vanishes(c, -s),
            "Fy" => vanishes(s, c),
            _ => self.moment.is_zero(),
        }
    }

    /// An integer multiple of a component in the world, the same for all reactions of a joint;
    /// `None` if there is none.
    fn whole(&self, component: &str, posed: &Posed) -> Option<BigInt> {
        let [c, s] = posed.turn;
        let [x, y] = &self.force;
        let sum = |a: Ratio, b: Ratio| match posed.stretch {
            1 => {
                let whole = |p: Ratio, q: Ratio| BigInt::from(p.numerator() * q.denominator());
                Some(whole(a, b) * x + whole(b, a) * y)
            }
            _ if b.is_zero() => Some(x.clone()),
            _ if a.is_zero() => Some(y.clone()),
            _ => None,
        };
        match component {
            "Fx" => sum(c, -s),
            "Fy" => sum(s, c),
            "T" => Some(self.moment.clone()),
            _ => None,
        }
    }

    /// Fx, Fy, T in the world, in a unit that is the same for all reactions of a drawing.
    #[must_use]
    pub fn rounded(&self, posed: &Posed) -> [f64; 3] {
        let number = |x: &BigInt| x.to_f64().unwrap_or(f64::NAN);
        let common = number(&self.common);
        let root = f64::from(posed.stretch).sqrt();
        let [c, s] = posed.turn.map(Ratio::rounded);
        let [x, y] = [number(&self.force[0]), root * number(&self.force[1])];
        [c * x - s * y, s * x + c * y, root * number(&self.moment)].map(|x| x / common)
    }
}

/// The rows of a drawing and the results for them.
pub struct Truth<'a> {
    /// The drawing.
    pub posed: &'a Posed,
    /// Its rows, in the order of the program.
    pub rows: Vec<Row>,
    /// Integer multiples of them, without the ground.
    whole: Vec<Vec<BigInt>>,
    /// The factor of each row.
    factors: Vec<BigInt>,
    exact: Exact,
}

impl<'a> Truth<'a> {
    /// Eliminates the rows of a drawing.
    #[must_use]
    pub fn of(posed: &'a Posed) -> Self {
        let rows = rows::rows(posed);
        let (mut whole, mut factors) = (Vec::new(), Vec::new());
        for row in &rows {
            let link = &posed.links[row.link].link;
            let mut entries = vec![Ratio::ZERO; 3 * posed.frames.len()];
            for (side, wrench) in rows::on_sides(row, link) {
                let Some(body) = side else { continue };
                for (entry, x) in entries[3 * body..].iter_mut().zip(wrench) {
                    *entry = *entry + x;
                }
            }
            // A multiple of all denominators, including those for the ground.
            let denominators = row.wrenches.iter().flat_map(|(_, w)| w);
            let factor = denominators.fold(1, |m, x| least_multiple(m, x.denominator()));
            let times = |x: Ratio| BigInt::from(x.numerator() * (factor / x.denominator()));
            whole.push(entries.into_iter().map(times).collect::<Vec<_>>());
            factors.push(BigInt::from(factor));
        }
        Self {
            posed,
            rows,
            exact: Exact::of_whole(whole.clone()),
            whole,
            factors,
        }
    }

    /// rank C
    #[must_use]
    pub fn rank(&self) -> usize {
        self.exact.rank()
    }

    /// Number of rows minus rank.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.rows.len() - self.rank()
    }

    /// The results in words: ranks, and the reactions that are not unique.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = format!(
            "rank {} of {} rows, redundancy {}; alone Φq {}, Ψ {}\n",
            self.rank(),
            self.rows.len(),
            self.redundancy(),
            self.rank_where(false),
            self.rank_where(true)
        );
        for (link, placed) in self.posed.links.iter().enumerate() {
            let rows = self.rows_of(link);
            if rows.iter().all(|&i| self.row_is_unique(i)) {
                continue;
            }
            let word = if self.is_unique(&rows) {
                "unique"
            } else {
                "not unique"
            };
            let free = self.free_wrenches(link).unwrap_or_default();
            let is_free = |axis: &&str| free.iter().any(|w| !w.is_zero(axis, self.posed));
            let axes: Vec<&str> = ["Fx", "Fy", "T"].into_iter().filter(is_free).collect();
            let free_rows = rows
                .iter()
                .filter(|&&i| !self.row_is_unique(i))
                .map(|i| i + 1);
            text.push_str(&format!(
                "{}: {word}, free are {axes:?}, and the multipliers of rows {:?}\n",
                placed.link.name,
                free_rows.collect::<Vec<_>>()
            ));
        }
        text.push_str("everything else is unique");
        text
    }

    /// The rank of some rows.
    #[must_use]
    pub fn rank_of(&self, rows: &[usize]) -> usize {
        self.select(rows).rank()
    }

    fn select(&self, rows: &[usize]) -> Exact {
        Exact::of_whole(rows.iter().map(|&i| self.whole[i].clone()).collect())
    }

    /// The rank of Φq, or that of Ψ.
    #[must_use]
    pub fn rank_where(&self, nonholonomic: bool) -> usize {
        let links = &self.posed.links;
        let is_own =
            |i: &usize| links[self.rows[*i].link].link.tie.is_nonholonomic() == nonholonomic;
        self.rank_of(&(0..self.rows.len()).filter(is_own).collect::<Vec<_>>())
    }

    /// The rows of a joint or drive.
    #[must_use]
    pub fn rows_of(&self, link: usize) -> Vec<usize> {
        let is_own = |i: &usize| self.rows[*i].link == link;
        (0..self.rows.len()).filter(is_own).collect()
    }

    /// Whether the reaction of these rows is the same in all solutions:
    /// `rank C = rank C_X + rank of the others`.
    #[must_use]
    pub fn is_unique(&self, rows: &[usize]) -> bool {
        self.is_unique_without(rows, &[])
    }

    /// Whether the rank is unchanged without some rows.
    #[must_use]
    pub fn keeps_motion(&self, deleted: &[usize]) -> bool {
        self.rank_of(&self.without(deleted)) == self.rank()
    }

    /// Whether the reaction of these rows is the same in all solutions after other rows are
    /// deleted.
    #[must_use]
    pub fn is_unique_without(&self, rows: &[usize], deleted: &[usize]) -> bool {
        let left = self.without(deleted);
        let (own, others): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| rows.contains(i));
        self.rank_of(&left) == self.rank_of(&own) + self.rank_of(&others)
    }

    fn without(&self, deleted: &[usize]) -> Vec<usize> {
        (0..self.rows.len())
            .filter(|i| !deleted.contains(i))
            .collect()
    }

    /// Whether the multiplier of a row is the same in all solutions.
    #[must_use]
    pub fn row_is_unique(&self, row: usize) -> bool {
        self.exact.row_is_unique(row)
    }

    /// The coefficients of these rows (of [`Truth::rows`], integer multiples of them) if they are
    /// minimally dependent.
    #[must_use]
    pub fn circuit(&self, rows: &[usize]) -> Option<Vec<BigInt>> {
        let exact = self.select(rows);
        match exact.null_space() {
            [z] if !z.iter().any(Zero::is_zero) => Some(z.clone()),
            _ => None,
        }
    }

    /// The same in the normalisation of the program: for its own rows, the largest of size 1.
    #[must_use]
    pub fn coefficients(&self, rows: &[usize], circuit: &[BigInt]) -> Vec<f64> {
        let sizes = circuit.iter().map(BigInt::bits);
        let excess = sizes.max().unwrap_or(0).saturating_sub(900);
        let own = rows.iter().zip(circuit).map(|(&i, z)| {
            let z = (z >> excess).to_f64().unwrap_or(f64::NAN);
            z * self.factors[i].to_f64().unwrap_or(f64::NAN) / self.rows[i].scale
        });
        let own: Vec<f64> = own.collect();
        let largest = own.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        own.into_iter().map(|x| x / largest).collect()
    }

    /// Whether the combination of two components of reactions that a circuit leaves as it is, is
    /// the same in all solutions. `N` is the only multiplier of its joint. `None` if a component is
    /// not rational.
    #[must_use]
    pub fn pair_is_unique(
        &self,
        (rows, circuit): (&[usize], &[BigInt]),
        pair: [(usize, &str); 2],
    ) -> Option<bool> {
        let mut parts = Vec::new();
        for (link, component) in pair {
            let mut coefficients = Vec::new();
            for i in self.rows_of(link) {
                let value = match component {
                    "N" => BigInt::from(1),
                    _ => {
                        let of_row = self.about_place(link, self.whole_wrench(i))?;
                        of_row.whole(component, self.posed)?
                    }
                };
                coefficients.push((i, value));
            }
            let in_circuit = |i: &usize| rows.iter().position(|row| row == i);
            let load: BigInt = coefficients
                .iter()
                .filter_map(|(i, c)| Some(c * &circuit[in_circuit(i)?]))
                .sum();
            parts.push((coefficients, load));
        }
        let mut l = vec![BigInt::zero(); self.rows.len()];
        for (own, other, sign) in [(0, 1, 1), (1, 0, -1)] {
            for (i, c) in &parts[own].0 {
                l[*i] += c * &parts[other].1 * BigInt::from(sign);
            }
        }
        Some(self.exact.determines(&l))
    }

    /// The wrench on the first body of a joint for multipliers of its rows, as integer multiples.
    fn wrench(&self, rows: &[usize], multipliers: &[BigInt]) -> [BigInt; 3] {
        let mut sum = [0; 3].map(|_| BigInt::zero());
        for (&i, z) in rows.iter().zip(multipliers) {
            for (total, x) in sum.iter_mut().zip(self.whole_wrench(i)) {
                *total += x * z;
            }
        }
        sum
    }

    /// The wrench of row i on the first body of its joint, which may occupy several slots.
    fn whole_wrench(&self, i: usize) -> [BigInt; 3] {
        let row = &self.rows[i];
        let link = &self.posed.links[row.link].link;
        let mut sum = [Ratio::ZERO; 3];
        let on_first = rows::on_sides(row, link).filter(|(side, _)| *side == link.sides[0]);
        for (total, x) in on_first.flat_map(|(_, wrench)| wrench.into_iter().enumerate()) {
            sum[total] = sum[total] + x;
        }
        sum.map(|x| BigInt::from(x.numerator()) * &self.factors[i] / BigInt::from(x.denominator()))
    }

    /// The wrenches on the first body of a joint without loads, one for each independent solution.
    /// `None` if the drawing does not define the place.
    #[must_use]
    pub fn free_wrenches(&self, link: usize) -> Option<Vec<Reaction>> {
        let rows = self.rows_of(link);
        let all = self.exact.null_space().iter();
        all.map(|z| {
            let own: Vec<BigInt> = rows.iter().map(|&i| z[i].clone()).collect();
            self.about_place(link, self.wrench(&rows, &own))
        })
        .collect()
    }

    /// The wrench of a joint in a circuit, in the same form.
    #[must_use]
    pub fn carried(&self, link: usize, rows: &[usize], circuit: &[BigInt]) -> Option<Reaction> {
        let own = rows.iter().zip(circuit);
        let own = own.filter(|(i, _)| self.rows[**i].link == link);
        let (rows, z): (Vec<usize>, Vec<BigInt>) = own.map(|(&i, z)| (i, z.clone())).unzip();
        self.about_place(link, self.wrench(&rows, &z))
    }

    fn about_place(&self, link: usize, [x, y, m]: [BigInt; 3]) -> Option<Reaction> {
        let [px, py] = rows::place(&self.posed.links[link].link.tie)?;
        let common = least_multiple(px.denominator(), py.denominator());
        let whole = |p: Ratio| BigInt::from(p.numerator() * (common / p.denominator()));
        let common = BigInt::from(common);
        let moment = &m * &common - whole(px) * &y + whole(py) * &x;
        Some(Reaction {
            force: [x * &common, y * &common],
            moment,
            common,
        })
    }

    /// Number of independent directions along which the wrench on the first body is the same in all
    /// solutions, without those along which it is always zero.
    #[must_use]
    pub fn live_directions(&self, link: usize) -> usize {
        let all = self.rows_of(link).into_iter();
        let all = all.map(|i| self.whole_wrench(i).to_vec()).collect();
        Exact::of_whole(all).rank() - self.free_directions(link)
    }

    /// The same including those, for the components that a reaction of this kind has.
    #[must_use]
    pub fn shared_directions(&self, link: usize, components: &[&str]) -> usize {
        components.len() - self.free_directions(link)
    }

    fn free_directions(&self, link: usize) -> usize {
        let rows = self.rows_of(link);
        let free = self.exact.null_space().iter().map(|z| {
            let own: Vec<BigInt> = rows.iter().map(|&i| z[i].clone()).collect();
            self.wrench(&rows, &own).to_vec()
        });
        Exact::of_whole(free.collect()).rank()
    }

    /// The sets of rows that are dependent directly or through others: connected components of the
    /// circuits.
    #[must_use]
    pub fn components(&self) -> Vec<BTreeSet<usize>> {
        let mut basis: Vec<usize> = Vec::new();
        let mut components: Vec<BTreeSet<usize>> = Vec::new();
        for i in 0..self.rows.len() {
            basis.push(i);
            let exact = self.select(&basis);
            let [z] = exact.null_space() else { continue };
            basis.pop();
            let with_i = basis.iter().chain([&i]).zip(z);
            let mut joined: BTreeSet<usize> = with_i
                .filter(|(_, z)| !z.is_zero())
                .map(|(i, _)| *i)
                .collect();
            components.retain(|other| {
                let touches = !other.is_disjoint(&joined);
                if touches {
                    joined.extend(other);
                }
                !touches
            });
            components.push(joined);
        }
        components
    }
}

impl Reference for Truth<'_> {
    fn ranks(&self) -> Ranks {
        Ranks {
            rows: self.rows.len(),
            velocities: 3 * self.posed.frames.len(),
            all: self.rank(),
            holonomic: self.rank_where(false),
            nonholonomic: self.rank_where(true),
            without_drives: None,
        }
    }

    fn rank_of(&self, rows: &[usize]) -> usize {
        Self::rank_of(self, rows)
    }

    fn reactions(&self) -> Vec<RightReaction> {
        let of_link = |link: usize| {
            let own = self.rows_of(link);
            let wrench = self.free_wrenches(link).map(|free| RightWrench {
                components: ["Fx", "Fy", "T"]
                    .map(|axis| {
                        (
                            axis,
                            free.iter().all(|w| w.is_zero(axis, self.posed)).into(),
                        )
                    })
                    .to_vec(),
                live: self.live_directions(link),
                is_open: false,
                free: free
                    .iter()
                    .map(|w| w.rounded(self.posed).to_vec())
                    .collect(),
            });
            RightReaction {
                name: self.posed.links[link].link.name.clone(),
                is_unique: self.is_unique(&own).into(),
                rows: own
                    .into_iter()
                    .map(|i| (i, self.row_is_unique(i).into()))
                    .collect(),
                wrench,
            }
        };
        (0..self.posed.links.len()).map(of_link).collect()
    }

    fn elsewhere(&self) -> Elsewhere {
        if self.posed.has_constant_rank {
            Elsewhere::Same
        } else {
            Elsewhere::Unknown
        }
    }

    fn rounding(&self) -> f64 {
        rounding(self.posed)
    }
}

fn least_multiple(a: i128, b: i128) -> i128 {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    a / x * b
}
