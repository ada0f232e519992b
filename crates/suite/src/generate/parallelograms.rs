//! A chain of parallelogram cells. The cranks of each cell are mounted on the coupler of the
//! previous cell. The cranks of the first cell are mounted on the ground.
//!
//! A cell with two cranks has 9 coordinates and 8 independent rows: its coupler moves on a circle
//! and does not rotate. A third crank adds three coordinates and four rows, and does not change the
//! motion of the coupler: 11 of the 12 rows are independent. Without any external load, the three
//! parallel cranks of a cell can have axial forces in the ratio 1 : −2 : 1. The resultant force and
//! torque of these axial forces on both couplers are zero, so the rest of the chain is not loaded.
//! Therefore each cell with three cranks has a redundancy of one. This redundancy involves only the
//! force components along the cranks in the six revolute joints of the cell. The force components
//! perpendicular to the cranks follow from the accelerations of the cranks.

use std::io;

use super::answer::{Answer, Free, FreeReaction};
use super::family::Family;
use super::points::{direction, step};
use super::share::Share;
use super::text::{BodyText, SceneText};
use crate::numbers::Numbers;

/// Distance between the cranks of a cell (m).
const DISTANCE: f64 = 1.0;

/// Height of the pivots above and below the centre of a coupler (m).
const HEIGHT: f64 = 0.1;

/// Mass (kg) and inertia (kg·m²) of a coupler.
const COUPLER: (f64, f64) = (2.0, 0.5);

const CRANK_MASS: f64 = 0.5;

pub(super) struct Parallelograms {
    n: usize,
    seed: u64,
    share: Share,
}

/// One cell.
struct Cell {
    number: usize,
    n_cranks: usize,
    /// Direction of the cranks. For cranks that are not horizontal, it points from the lower end to
    /// the upper end.
    direction: [f64; 2],
    length: f64,
    /// Centre of the coupler below the cell. For the first cell, this is the reference point on the
    /// ground.
    base: [f64; 2],
    /// Height of the pivots above this centre.
    rise: f64,
    /// Centre of the coupler of the cell.
    coupler: [f64; 2],
}

impl Cell {
    /// Returns both ends of a crank.
    fn ends(&self, crank: usize) -> [[f64; 2]; 2] {
        let across = DISTANCE * (crank as f64 - 0.5 * (self.n_cranks as f64 - 1.0));
        let low = [self.base[0] + across, self.base[1] + self.rise];
        [low, step(low, self.length, self.direction)]
    }
}

impl Parallelograms {
    pub(super) fn new(n: usize, seed: u64, share: f64) -> Self {
        Self {
            n,
            seed,
            share: Share::of(n, share),
        }
    }

    /// Returns the cells in their order. Cranks lean back towards the origin, so that a chain of
    /// any length is in a small region.
    fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        let mut numbers = Numbers::new(self.seed);
        let (mut base, mut rise) = ([0.0; 2], 0.0);
        (0..self.n).map(move |number| {
            let lean = numbers.within(0.4, 1.2);
            let length = numbers.within(0.5, 1.5);
            let [x, y] = direction(lean);
            let towards = |at: f64| if at > 0.0 { -1.0 } else { 1.0 };
            let direction = [x * towards(base[0]), y * towards(base[1])];
            let pivots = [base[0], base[1] + rise];
            let top = step(pivots, length, direction);
            let cell = Cell {
                number,
                n_cranks: if self.share.has(number) { 3 } else { 2 },
                direction,
                length,
                base,
                rise,
                coupler: [top[0], top[1] + HEIGHT],
            };
            (base, rise) = (cell.coupler, HEIGHT);
            cell
        })
    }
}

impl Family for Parallelograms {
    fn answer(&self) -> Answer {
        let three = self.share.chosen;
        let cranks = 2 * self.n + three;
        Answer::new(cranks + self.n, 2 * cranks, 0, 4 * cranks, three)
    }

    fn free_reactions(&self) -> Vec<FreeReaction> {
        let redundant = self.cells().filter(|cell| cell.n_cranks == 3);
        let joints = redundant.flat_map(|cell| {
            let (c, free) = (cell.number, Free::Along(cell.direction));
            let of_crank = move |k: usize| {
                [format!("low-{c}-{k}"), format!("top-{c}-{k}")]
                    .map(|name| FreeReaction::new(name, free))
            };
            (0..3).flat_map(of_crank)
        });
        joints.collect()
    }

    fn words(&self) -> Vec<String> {
        vec![
            format!(
                "a chain of {} parallelogram cells, {} of them with three cranks; seed {}.",
                self.n, self.share.chosen, self.seed
            ),
            "Not unique: in cells with three cranks, the reactions of all six revolutes along the cranks."
                .to_owned(),
        ]
    }

    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()> {
        scene.scene(name, [0.0, -9.81])?;
        for cell in self.cells() {
            let c = cell.number;
            for k in 0..cell.n_cranks {
                let [low, top] = cell.ends(k);
                let crank = BodyText::rod(CRANK_MASS, low, top);
                scene.body(format_args!("crank-{c}-{k}"), &crank)?;
            }
            let (mass, inertia) = COUPLER;
            let coupler = BodyText {
                mass,
                inertia,
                position: cell.coupler,
                ..BodyText::default()
            };
            scene.body(format_args!("coupler-{c}"), &coupler)?;
        }
        for cell in self.cells() {
            let c = cell.number;
            for k in 0..cell.n_cranks {
                let [low, top] = cell.ends(k);
                let crank = format_args!("crank-{c}-{k}");
                let low_name = format_args!("low-{c}-{k}");
                match c.checked_sub(1) {
                    None => scene.revolute(low_name, [&"ground", &crank], low),
                    Some(below) => {
                        scene.revolute(low_name, [&format_args!("coupler-{below}"), &crank], low)
                    }
                }?;
                scene.revolute(
                    format_args!("top-{c}-{k}"),
                    [&crank, &format_args!("coupler-{c}")],
                    top,
                )?;
            }
        }
        scene.run_to(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_of_nine_thousand_cells() {
        let answer = Parallelograms::new(9000, 1, 2.0 / 3.0).answer();
        assert_eq!((answer.bodies, answer.joints), (33_000, 48_000));
        assert_eq!((answer.rows, 3 * answer.bodies), (96_000, 99_000));
        assert_eq!((answer.redundancy, answer.mobility), (6000, 9000));
    }

    #[test]
    fn a_long_chain_stays_in_a_small_place() {
        let chain = Parallelograms::new(10_000, 7, 0.5);
        let far = chain.cells().flat_map(|cell| cell.coupler).map(f64::abs);
        assert!(far.fold(0.0, f64::max) < 3.0);
        // The distance between the pivots of two cranks equals the distance of the cranks in the
        // cell.
        let cell = chain.cells().nth(5000).expect("there are 10000");
        let [low, top] = cell.ends(1);
        let length = (top[0] - low[0]).hypot(top[1] - low[1]);
        assert!((length - cell.length).abs() < 1e-14);
    }
}
