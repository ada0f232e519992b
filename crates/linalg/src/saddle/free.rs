//! The free motions, which satisfy all rows. This file computes a basis N of the free motions, the
//! reduced mass `Nᵀ·M·N`, and its Cholesky factorisation without square roots.
//!
//! Each null vector belongs to one free coordinate. The entry of the vector is one in this
//! coordinate and zero in the other free coordinates. The other entries of the vector belong to
//! coordinates that the rows couple to this free coordinate. If a null vector has few other
//! entries, most entries of the reduced mass are zero. A null vector has few other entries, for
//! example, if rows of a long mechanism are skipped for an instant. Therefore vectors with few
//! entries come first, and each row of the factor begins with its first entry.

use super::error::SaddleError;
use super::lists::Entry;
use super::lu::TallLu;
use crate::kernels::{axpy, dot, max_abs};
use crate::limits::RESERVED;
use crate::{AddedMass, MassMatrix};

/// Null space basis, masses, and factors of the reduced mass of k = n − r free motions.
#[derive(Debug, Clone)]
pub(super) struct FreeMotions {
    pub(super) basis: Basis,
    pub(super) k: usize,
    /// Diagonal of M, and its rows.
    pub(super) mass: Vec<f64>,
    pub(super) added: AddedMass,
    /// Product of a row of M and N, k values.
    along: Vec<f64>,
    /// Squared norms of the null vectors without their free coordinates.
    squared: Vec<f64>,
    /// Factors L·D·Lᵀ of NᵀMN: unit lower L with D on the diagonal. The array is k×k and row-major;
    /// row i is zero before `begin[i]`.
    reduced_mass: Vec<f64>,
    begin: Vec<usize>,
    /// Buffer for Nᵀ·g and the corresponding free motions.
    z: Vec<f64>,
    /// Smallest fraction of a diagonal entry of NᵀMN that remained after elimination; infinite for
    /// k = 0.
    pub(super) mass_ratio: f64,
}

/// The n×k matrix N by its rows, with only the entries that can be nonzero.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Rows of the free coordinates, followed by the rows of the other coordinates in the reverse
    /// order of the rows of C. If only one motion is free, as in most mechanisms, the basis has one
    /// entry for each coordinate, in the order of the coordinates.
    entries: Vec<Entry>,
    /// Start and end of the row of each coordinate.
    rows: Vec<[u32; 2]>,
    /// Buffer for a row, k values.
    row: Vec<f64>,
    /// Buffer for the number of entries of each null vector. A second buffer contains the positions
    /// of the null vectors when they are sorted by this number.
    count: Vec<usize>,
    place: Vec<u32>,
}

impl Basis {
    #[inline(always)]
    pub(super) fn of(&self, coordinate: usize) -> &[Entry] {
        let [begin, end] = self.rows[coordinate];
        &self.entries[begin as usize..end as usize]
    }

    /// Finds the positions of the entries, and sorts the free coordinates by the number of entries
    /// of their null vectors.
    fn follow(&mut self, lu: &mut TallLu) {
        let k = lu.free.len();
        let Self {
            entries,
            rows,
            row,
            count,
            place,
        } = self;
        entries.clear();
        if let [free] = lu.free[..] {
            for (i, row) in rows.iter_mut().enumerate() {
                *row = [i as u32, i as u32 + 1];
                entries.push(Entry::new(0, f64::from(u8::from(i == free))));
            }
            return;
        }
        row.clear();
        row.resize(k, 0.0);
        for (c, &i) in lu.free.iter().enumerate() {
            rows[i] = [c as u32, c as u32 + 1];
            entries.push(Entry::new(c, 1.0));
        }
        count.clear();
        count.resize(k, 0);
        place.clear();
        place.resize(k, 0);
        for (at, below) in lu.backward() {
            let begin = entries.len();
            for l in below {
                let [from, to] = rows[l.index()];
                for e in from as usize..to as usize {
                    let c = entries[e].index();
                    if std::mem::replace(&mut row[c], 1.0) == 0.0 {
                        entries.push(Entry::new(c, 0.0));
                    }
                }
            }
            entries[begin..].sort_unstable_by_key(|entry| entry.index);
            for entry in &entries[begin..] {
                row[entry.index()] = 0.0;
                count[entry.index()] += 1;
            }
            rows[at] = [begin as u32, entries.len() as u32];
        }
        lu.free
            .sort_unstable_by_key(|&i| (count[rows[i][0] as usize], i));
        for (new, &i) in lu.free.iter().enumerate() {
            place[rows[i][0] as usize] = new as u32;
        }
        for entry in entries.iter_mut() {
            entry.index = place[entry.index()];
        }
    }

    /// Solves `L₁ᵀ·N₁ = −L₂ᵀ`.
    fn solve(&mut self, lu: &TallLu) {
        let Self {
            entries, rows, row, ..
        } = self;
        if lu.free.len() == 1 {
            for (at, below) in lu.backward() {
                let terms = below.iter().map(|l| l.value * entries[l.index()].value);
                entries[at].value = -terms.sum::<f64>();
            }
            return;
        }
        for (at, below) in lu.backward() {
            let [begin, end] = rows[at];
            let (known, rest) = entries.split_at_mut(begin as usize);
            for l in below {
                let [from, to] = rows[l.index()];
                for entry in &known[from as usize..to as usize] {
                    row[entry.index()] -= l.value * entry.value;
                }
            }
            for entry in &mut rest[..(end - begin) as usize] {
                entry.value = std::mem::take(&mut row[entry.index()]);
            }
        }
    }
}

impl FreeMotions {
    /// Allocates storage for n coordinates and k free motions. If there are more free motions
    /// because rows are skipped, more storage is allocated once.
    pub(super) fn new(n: usize, k: usize) -> Self {
        Self {
            basis: Basis {
                entries: Vec::with_capacity((n * k).min(RESERVED)),
                rows: vec![[0; 2]; n],
                row: Vec::with_capacity(k),
                count: Vec::with_capacity(k),
                place: Vec::with_capacity(k),
            },
            k,
            mass: vec![0.0; n],
            added: AddedMass::default(),
            along: Vec::new(),
            squared: vec![0.0; k],
            reduced_mass: vec![0.0; k * k],
            begin: vec![0; k],
            z: vec![0.0; k],
            mass_ratio: f64::INFINITY,
        }
    }

    /// Adapts the storage to other pivot coordinates, and sorts the free coordinates.
    pub(super) fn follow(&mut self, lu: &mut TallLu) {
        self.basis.follow(lu);
        self.k = lu.free.len();
        let k = self.k;
        self.squared.resize(k, 0.0);
        self.reduced_mass.resize(k * k, 0.0);
        self.z.resize(k, 0.0);
        self.begin.clear();
        self.begin.extend(0..k);
        for &i in lu.pivots() {
            let row = self.basis.of(i);
            if let Some(first) = row.iter().map(Entry::index).min() {
                for entry in row {
                    let begin = &mut self.begin[entry.index()];
                    *begin = first.min(*begin);
                }
            }
        }
    }

    /// Computes the basis and the factors for these rows and masses. `entry(row, coordinate)` is an
    /// entry of C relative to the largest entry of its row.
    pub(super) fn factor(
        &mut self,
        lu: &TallLu,
        entry: impl Fn(usize, usize) -> f64,
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        self.mass.copy_from_slice(mass.diagonal());
        self.basis.solve(lu);
        self.reduce_mass(lu);
        if !(self.added.is_empty() && mass.added().is_empty()) {
            self.added.copy(mass.added());
            self.reduce_added();
        }
        self.factor_reduced_mass(lu, entry)
    }

    /// Computes the lower triangle of NᵀMN, and the squares of the null vectors.
    fn reduce_mass(&mut self, lu: &TallLu) {
        let k = self.k;
        self.squared.fill(0.0);
        self.reduced_mass.fill(0.0);
        if k == 1 {
            let [mut squared, mut reduced] = [-1.0, 0.0];
            for (entry, m) in self.basis.entries.iter().zip(&self.mass) {
                squared += entry.value * entry.value;
                reduced += m * (entry.value * entry.value);
            }
            (self.squared[0], self.reduced_mass[0]) = (squared, reduced);
            return;
        }
        for &i in lu.pivots() {
            let row = self.basis.of(i);
            for a in row {
                self.squared[a.index()] += a.value * a.value;
                let weighted = self.mass[i] * a.value;
                let of_a = &mut self.reduced_mass[a.index() * k..][..=a.index()];
                for b in row.iter().filter(|b| b.index() <= a.index()) {
                    of_a[b.index()] += weighted * b.value;
                }
            }
        }
        for (c, &i) in lu.free.iter().enumerate() {
            self.reduced_mass[c * k + c] += self.mass[i];
        }
    }

    /// Adds `Σ a·(g·N)ᵀ·(g·N)` to the lower triangle of NᵀMN.
    fn reduce_added(&mut self) {
        let Self {
            basis,
            k,
            added,
            along,
            reduced_mass,
            begin,
            ..
        } = self;
        let k = *k;
        for (inertia, columns, values) in added.rows() {
            along.clear();
            along.resize(k, 0.0);
            for (&i, g) in columns.iter().zip(values) {
                for entry in basis.of(i) {
                    along[entry.index()] += g * entry.value;
                }
            }
            let Some(first) = along.iter().position(|x| *x != 0.0) else {
                continue;
            };
            for c in first..k {
                if along[c] != 0.0 {
                    begin[c] = begin[c].min(first);
                    axpy(
                        inertia * along[c],
                        &along[first..=c],
                        &mut reduced_mass[c * k + first..=c * k + c],
                    );
                }
            }
        }
    }

    /// Computes the Cholesky factorisation of `NᵀMN` without roots, L·D·Lᵀ.
    fn factor_reduced_mass(
        &mut self,
        lu: &TallLu,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Result<(), SaddleError> {
        let (n, k) = (lu.n, self.k);
        self.mass_ratio = f64::INFINITY;
        if k == 0 {
            return Ok(());
        }
        // The relative rounding error has two causes: cancellation in NᵀMN, and rounding of N. N is
        // exact in the free coordinates, and its rounding may change a zero into a mass.
        let cancelled = k as f64 * f64::EPSILON;
        let relative = (n as f64 * f64::EPSILON).powi(2);
        let added = self.added.heaviest();
        let heaviest = max_abs(&self.mass).max(added);
        for i in 0..k {
            let (above, rest) = self.reduced_mass.split_at_mut(i * k);
            let l_i = &mut rest[..k];
            let size = l_i[i];
            let begin = self.begin[i];
            // The loop first computes v_j = l_ij·d_j, then l_ij: L has a unit diagonal, and d is
            // stored in its place.
            for j in begin..i {
                let from = begin.max(self.begin[j]);
                let of_j = &above[j * k..j * k + j];
                if from < j {
                    l_i[j] -= dot(&l_i[from..j], &of_j[from..]);
                }
            }
            let mut reduced = size;
            for j in begin..i {
                let v_j = l_i[j];
                l_i[j] /= above[j * k + j];
                reduced -= v_j * l_i[j];
            }
            let squared = self.squared[i];
            let floor = |mass: f64, share: f64| {
                (cancelled * size).max(relative * mass * (share * share + squared))
            };
            let is_lost = reduced <= floor(heaviest, 1.0) && {
                let dependent = lu.pivots().iter().map(|&i| self.mass[i]);
                // The rounding error of a null vector is relative to the entries that its
                // coordinate has in the rows.
                let shares = lu.used().iter().map(|&row| entry(row, lu.free[i]));
                reduced <= floor(dependent.fold(added, f64::max), shares.fold(0.0, f64::max))
            };
            if reduced.is_nan() || is_lost {
                return Err(SaddleError::MasslessMotion {
                    reduced,
                    size: size.max(heaviest),
                    motion: self.massless_motion(n, i),
                });
            }
            self.mass_ratio = self.mass_ratio.min(reduced / size);
            l_i[i] = reduced;
        }
        Ok(())
    }

    /// Returns the motion `N·z` with `z = [−L₁₁⁻ᵀ·l_i; 1; 0]` that belongs to the failed pivot i.
    fn massless_motion(&self, n: usize, i: usize) -> Vec<f64> {
        let k = self.k;
        let mut z = vec![0.0; k];
        z[i] = 1.0;
        for j in 0..i {
            z[j] = -self.reduced_mass[i * k + j];
        }
        for j in (0..i).rev() {
            let z_j = z[j];
            axpy(-z_j, &self.reduced_mass[j * k..j * k + j], &mut z[..j]);
        }
        let entry = |i: usize| {
            self.basis
                .of(i)
                .iter()
                .map(|e| e.value * z[e.index()])
                .sum()
        };
        let mut motion: Vec<f64> = (0..n).map(entry).collect();
        let largest = max_abs(&motion);
        motion.iter_mut().for_each(|x| *x /= largest);
        motion
    }

    /// Computes y ← y + N·z with `(NᵀMN)·z = Nᵀ·g`.
    pub(super) fn add(&mut self, g: &[f64], y: &mut [f64]) {
        let Self {
            basis,
            k,
            reduced_mass,
            begin,
            z,
            ..
        } = self;
        let k = *k;
        if k == 1 {
            let terms = basis.entries.iter().zip(g);
            let of_g: f64 = terms.map(|(entry, g)| entry.value * g).sum();
            let z = of_g / reduced_mass[0];
            for (y, entry) in y.iter_mut().zip(&basis.entries) {
                *y += z * entry.value;
            }
            return;
        }
        z.fill(0.0);
        for (i, g_i) in g.iter().enumerate() {
            for entry in basis.of(i) {
                z[entry.index()] += entry.value * g_i;
            }
        }
        for c in 0..k {
            let from = begin[c];
            z[c] -= dot(&reduced_mass[c * k + from..c * k + c], &z[from..c]);
        }
        for c in 0..k {
            z[c] /= reduced_mass[c * k + c];
        }
        for c in (0..k).rev() {
            let (z_c, from) = (z[c], begin[c]);
            let row = &reduced_mass[c * k + from..c * k + c];
            axpy(-z_c, row, &mut z[from..c]);
        }
        for (i, y_i) in y.iter_mut().enumerate() {
            *y_i += basis
                .of(i)
                .iter()
                .map(|entry| entry.value * z[entry.index()])
                .sum::<f64>();
        }
    }
}
