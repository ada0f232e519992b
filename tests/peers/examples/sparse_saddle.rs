//! The saddle system of large mechanisms, `M·a + Cᵀ·λ = f`, `C·a = γ` on independent rows. It is
//! solved by the Schur complement of `linalg` and by sparse Cholesky and LU of faer. The program
//! compares time, memory, accuracy and rejected input, and whether two runs give the same bits.
//!
//! `cargo run --release --manifest-path tests/peers/Cargo.toml --example sparse_saddle`
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

use dynamics::PreparedMechanism;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::cholesky::factorize_symbolic_cholesky;
use faer::sparse::linalg::solvers::{Llt, Lu, SymbolicLlt, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Col, Par, Side};
use suite::generate::{Kind, Order};
use linalg::{SchurSaddle, SchurStructure, SparseMatrix};
use model::System;
use pfaff::{RunOptions, Study};

/// Number of runs of each solver; the shortest time counts.
const RUNS: usize = 15;

fn main() -> Result<(), Box<dyn Error>> {
    faer::set_global_parallelism(Par::Seq);
    println!(
        "scene                  rows  solver         analysis   assemble     factor      solve   \
         entries   misfit"
    );
    let orders = [
        (Kind::Parallelograms, 9000),
        (Kind::Fleet, 1000),
        (Kind::Lattice, 100),
        (Kind::Random, 8000),
    ];
    for (kind, n) in orders {
        let generator = Order::of(kind, n).generate()?;
        let mut text = Vec::new();
        generator.write(&mut text)?;
        let text = String::from_utf8(text)?;
        let registry = model::Registry::standard();
        let study = Study::read(&generator.name(), &text, &registry, &RunOptions::default())?;
        compare(&generator.name(), &SaddleSystem::of(&study.prepared)?)?;
    }
    Ok(())
}

/// The system at the start.
struct SaddleSystem {
    c: SparseMatrix,
    blocks: Vec<std::ops::Range<usize>>,
    mass: Vec<f64>,
    force: Vec<f64>,
    gamma: Vec<f64>,
}

impl SaddleSystem {
    fn of(prepared: &PreparedMechanism) -> Result<Self, Box<dyn Error>> {
        let mechanism = &prepared.mechanism;
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &prepared.q, &mut s);
        mechanism.c(&mut s);
        let kept = &prepared.decision.kept;
        let pattern = &layout.pattern;
        let rows = kept.iter().map(|&i| {
            let entries = pattern.start[i]..pattern.start[i + 1];
            entries
                .map(|at| (pattern.column[at], s.entries[pattern.entry[at]]))
                .collect::<Vec<_>>()
        });
        let n = layout.n_v;
        Ok(Self {
            c: SparseMatrix::from_rows(n, rows)?,
            blocks: (0..mechanism.bodies().len())
                .map(|b| layout.columns(b))
                .collect(),
            mass: mechanism.mass().to_vec(),
            force: (0..n)
                .map(|j| if j % 3 == 1 { -9.81 } else { 0.3 })
                .collect(),
            gamma: (0..kept.len()).map(|i| 0.1 * (i as f64).sin()).collect(),
        })
    }

    /// Largest residual of both equations, relative to the largest force and acceleration.
    fn misfit(&self, a: &[f64], lambda: &[f64]) -> f64 {
        let (mut ca, mut ct) = (vec![0.0; self.gamma.len()], vec![0.0; self.mass.len()]);
        self.c.times(a, &mut ca);
        self.c.transposed_times(lambda, &mut ct);
        let worst = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |w: f64, x| w.max(x.abs()));
        let size = worst(&mut a.iter().copied());
        let load = worst(&mut lambda.iter().copied()).max(worst(&mut self.force.iter().copied()));
        let kinematic = worst(&mut ca.iter().zip(&self.gamma).map(|(x, g)| x - g)) / size;
        let forces = (0..a.len()).map(|j| self.mass[j] * a[j] + ct[j] - self.force[j]);
        kinematic.max(worst(&mut { forces }) / load)
    }
}

/// Shortest time (s) of some runs, and the last result.
fn timed<T>(mut f: impl FnMut() -> T) -> (f64, T) {
    let mut least = f64::INFINITY;
    let mut last = None;
    for _ in 0..RUNS {
        let clock = Instant::now();
        let made = f();
        least = least.min(clock.elapsed().as_secs_f64());
        last = Some(made);
    }
    (least, last.unwrap_or_else(f))
}

fn line(name: &str, rows: usize, solver: &str, ms: [f64; 4], entries: usize, misfit: f64) {
    let [analysis, assemble, factor, solve] = ms.map(|s| 1e3 * s);
    println!(
        "{name:20} {rows:6}  {solver:12} {analysis:7.1} ms {assemble:7.2} ms {factor:7.2} ms \
         {solve:7.2} ms {entries:9}  {misfit:.1e}"
    );
}

fn compare(name: &str, system: &SaddleSystem) -> Result<(), Box<dyn Error>> {
    ours(name, system)?;
    cholesky(name, system)?;
    lu(name, system)
}

fn ours(name: &str, system: &SaddleSystem) -> Result<(), Box<dyn Error>> {
    let (r, n) = (system.gamma.len(), system.mass.len());
    let clock = Instant::now();
    let structure = SchurStructure::new(&system.c, &system.blocks);
    let analysis = clock.elapsed().as_secs_f64();
    let entries = structure.n_entries();
    let mut saddle = SchurSaddle::new(structure);
    let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
    let (factor, made) = timed(|| saddle.factor(&system.c, &system.mass));
    made?;
    let (solve, made) =
        timed(|| saddle.solve(&system.c, &system.force, &system.gamma, &mut a, &mut lambda));
    made?;
    let misfit = system.misfit(&a, &lambda);
    line(
        name,
        r,
        "linalg",
        [analysis, 0.0, factor, solve],
        entries,
        misfit,
    );
    let before = lambda.clone();
    saddle.factor(&system.c, &system.mass)?;
    saddle.solve(&system.c, &system.force, &system.gamma, &mut a, &mut lambda)?;
    println!("  same bits again: {}", before == lambda);
    // One row occurs twice.
    let mut rows: Vec<Vec<(usize, f64)>> = (0..r).map(|i| system.c.entries(i).collect()).collect();
    rows.push(rows[r / 2].clone());
    let doubled = SparseMatrix::from_rows(n, rows)?;
    let mut saddle = SchurSaddle::new(SchurStructure::new(&doubled, &system.blocks));
    println!(
        "  a row twice: {:?}",
        saddle
            .factor(&doubled, &system.mass)
            .err()
            .map(|e| e.to_string())
    );
    Ok(())
}

/// `S = C·M⁻¹·Cᵀ` by the products of entries of each column, in a fixed pattern.
struct Schur {
    matrix: SparseColMat<usize, f64>,
    /// For each product: its position in S, both entries, and the column.
    products: Vec<(u32, u32, u32, u32)>,
}

impl Schur {
    fn new(c: &SparseMatrix) -> Result<Self, Box<dyn Error>> {
        let t = c.transpose();
        let mut triplets = Vec::new();
        for j in 0..c.ncols() {
            let rows = t.row(j).0;
            for (k, &i) in rows.iter().enumerate() {
                triplets.extend(rows[..=k].iter().map(|&l| Triplet::new(i, l, 0.0)));
            }
        }
        let r = c.nrows();
        let matrix =
            SparseColMat::try_new_from_triplets(r, r, &triplets).map_err(|e| format!("{e:?}"))?;
        let symbolic = matrix.symbolic();
        let place = |i: usize, l: usize| {
            let range = symbolic.col_range(l);
            range.start + symbolic.row_idx()[range.clone()].partition_point(|&row| row < i)
        };
        // Entries of C are stored by rows; this finds the entry of a column in a row.
        let entry = |i: usize, j: usize| c.start(i) + c.row(i).0.partition_point(|&k| k < j);
        let mut products = Vec::with_capacity(triplets.len());
        for j in 0..c.ncols() {
            let rows = t.row(j).0;
            for (k, &i) in rows.iter().enumerate() {
                for &l in &rows[..=k] {
                    let places = [place(i, l), entry(i, j), entry(l, j), j].map(|x| x as u32);
                    products.push((places[0], places[1], places[2], places[3]));
                }
            }
        }
        Ok(Self { matrix, products })
    }

    fn assemble(&mut self, c: &SparseMatrix, inverse_mass: &[f64]) {
        let values = self.matrix.val_mut();
        values.fill(0.0);
        let entries = c.values();
        for &(at, x, y, j) in &self.products {
            values[at as usize] +=
                entries[x as usize] * entries[y as usize] * inverse_mass[j as usize];
        }
    }
}

fn cholesky(name: &str, system: &SaddleSystem) -> Result<(), Box<dyn Error>> {
    let r = system.gamma.len();
    if system.mass.contains(&0.0) {
        println!("{name:20} {r:6}  faer Llt: bodies without mass have no S");
        return Ok(());
    }
    let inverse: Vec<f64> = system.mass.iter().map(|m| 1.0 / m).collect();
    let clock = Instant::now();
    let mut schur = Schur::new(&system.c)?;
    let symbolic =
        SymbolicLlt::try_new(schur.matrix.symbolic(), Side::Lower).map_err(|e| format!("{e:?}"))?;
    let analysis = clock.elapsed().as_secs_f64();
    let entries = factorize_symbolic_cholesky(
        schur.matrix.symbolic(),
        Side::Lower,
        Default::default(),
        Default::default(),
    )
    .map_err(|e| format!("{e:?}"))?
    .len_val();
    let (assemble, ()) = timed(|| schur.assemble(&system.c, &inverse));
    let factored =
        || Llt::try_new_with_symbolic(symbolic.clone(), schur.matrix.as_ref(), Side::Lower);
    let (factor, made) = timed(factored);
    let llt = made.map_err(|e| format!("{e:?}"))?;
    let n = system.mass.len();
    let solution = || {
        // S·λ = C·M⁻¹·f − γ, a = M⁻¹·(f − Cᵀ·λ)
        let free: Vec<f64> = system
            .force
            .iter()
            .zip(&inverse)
            .map(|(f, w)| f * w)
            .collect();
        let mut rhs = vec![0.0; r];
        system.c.times(&free, &mut rhs);
        let rhs = Col::from_fn(r, |i| rhs[i] - system.gamma[i]);
        let lambda = llt.solve(&rhs);
        let lambda: Vec<f64> = (0..r).map(|i| lambda[i]).collect();
        let mut a = vec![0.0; n];
        system.c.transposed_times(&lambda, &mut a);
        for j in 0..n {
            a[j] = inverse[j] * (system.force[j] - a[j]);
        }
        (a, lambda)
    };
    let (solve, (a, lambda)) = timed(solution);
    let misfit = system.misfit(&a, &lambda);
    line(
        name,
        r,
        "faer Llt",
        [analysis, assemble, factor, solve],
        entries,
        misfit,
    );
    let again = factored().map_err(|e| format!("{e:?}"))?;
    let rhs = Col::from_fn(r, |i| (i as f64).cos());
    println!(
        "  same bits again: {}",
        again.solve(&rhs) == llt.solve(&rhs)
    );
    // One row occurs twice.
    let mut rows: Vec<Vec<(usize, f64)>> = (0..r).map(|i| system.c.entries(i).collect()).collect();
    rows.push(rows[r / 2].clone());
    let doubled = SparseMatrix::from_rows(n, rows)?;
    let mut schur = Schur::new(&doubled)?;
    schur.assemble(&doubled, &inverse);
    let symbolic =
        SymbolicLlt::try_new(schur.matrix.symbolic(), Side::Lower).map_err(|e| format!("{e:?}"))?;
    let made = Llt::try_new_with_symbolic(symbolic, schur.matrix.as_ref(), Side::Lower);
    println!("  a row twice: {:?}", made.err().map(|e| format!("{e:?}")));
    Ok(())
}

fn lu(name: &str, system: &SaddleSystem) -> Result<(), Box<dyn Error>> {
    let (r, n) = (system.gamma.len(), system.mass.len());
    let clock = Instant::now();
    let mut triplets: Vec<Triplet<usize, usize, f64>> =
        (0..n).map(|j| Triplet::new(j, j, system.mass[j])).collect();
    for i in 0..r {
        for (j, value) in system.c.entries(i) {
            triplets.push(Triplet::new(n + i, j, value));
            triplets.push(Triplet::new(j, n + i, value));
        }
    }
    let matrix = SparseColMat::try_new_from_triplets(n + r, n + r, &triplets)
        .map_err(|e| format!("{e:?}"))?;
    let symbolic = SymbolicLu::try_new(matrix.symbolic()).map_err(|e| format!("{e:?}"))?;
    let analysis = clock.elapsed().as_secs_f64();
    let factored = || Lu::try_new_with_symbolic(symbolic.clone(), matrix.as_ref());
    let (factor, made) = timed(factored);
    let lu = match made {
        Ok(lu) => lu,
        Err(e) => {
            println!("{name:20} {r:6}  faer Lu refuses: {e:?}");
            return Ok(());
        }
    };
    let rhs = Col::from_fn(n + r, |k| {
        if k < n {
            system.force[k]
        } else {
            system.gamma[k - n]
        }
    });
    let (solve, x) = timed(|| lu.solve(&rhs));
    let a: Vec<f64> = (0..n).map(|j| x[j]).collect();
    let lambda: Vec<f64> = (n..n + r).map(|i| x[i]).collect();
    let misfit = system.misfit(&a, &lambda);
    line(
        name,
        r,
        "faer Lu",
        [analysis, 0.0, factor, solve],
        0,
        misfit,
    );
    Ok(())
}
