//! A square lattice of N × N cells is suspended from a corner. Each side is a rod that is pinned at
//! the nodes. In blocks of cells, braces are along the diagonals.
//!
//! Without braces, opposite sides of each cell remain parallel. Therefore every column of cells has
//! one angle, every row of cells has another angle, and these 2·N angles are the degrees of
//! freedom. A brace makes the angle of its column equal to the angle of its row (Bolker and Crapo,
//! Bracing rectangular frameworks I, SIAM J. Appl. Math. 36, 1979, doi 10.1137/0136036: braces are
//! edges between rows and columns). Each braced block of 2 × 2 cells has four braces between two
//! rows and two columns: three braces make four angles equal, and the fourth brace is redundant.
//! Therefore a lattice with k braced blocks has `2·N − 3·k` degrees of freedom and a redundancy of
//! k.
//!
//! Without any external load, the braces of a block can have tensions in the ratio `1, −1, −1, 1`
//! (times √2). On each line of rods, the sum of the brace forces along this line is then zero.
//! Therefore the sides of the block balance these forces, and rods outside the block have no load.
//! The pins of a node connect its rods in the order of a list. The force in a pin is the sum of the
//! tensions of the rods before this pin in the list. Each component of this sum is an integer,
//! which [`Lattice::free`] computes without rounding.

use std::io;

use super::answer::{Answer, Free, FreeReaction};
use super::family::Family;
use super::share::Share;
use super::text::{BodyText, SceneText};

/// Cells along each side of a block.
const BLOCK: usize = 2;

/// Braces of a block.
const BRACES: usize = 4;

const ROD_MASS: f64 = 1.0;

pub(super) struct Lattice {
    n: usize,
    /// The blocks along the diagonal that are braced.
    braced: Share,
}

/// A rod that starts at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rod {
    /// Rod to the next column.
    Across([usize; 2]),
    /// Rod to the next row, downwards.
    Down([usize; 2]),
    /// Rod to the next column and row.
    Brace([usize; 2]),
}

impl Rod {
    fn name(self) -> String {
        match self {
            Self::Across([c, r]) => format!("across-{c}-{r}"),
            Self::Down([c, r]) => format!("down-{c}-{r}"),
            Self::Brace([c, r]) => format!("brace-{c}-{r}"),
        }
    }

    fn start(self) -> [usize; 2] {
        match self {
            Self::Across(node) | Self::Down(node) | Self::Brace(node) => node,
        }
    }

    /// Number of columns and rows from the start to the end of the rod.
    fn step(self) -> [usize; 2] {
        match self {
            Self::Across(_) => [1, 0],
            Self::Down(_) => [0, 1],
            Self::Brace(_) => [1, 1],
        }
    }

    /// Returns the tension of the rod in the self-stress of a block (number from 0 along the
    /// diagonal).
    fn pull(self, block: usize) -> i32 {
        /// Tensions by column and line for horizontal rods. For vertical rods, column and line are
        /// exchanged.
        const SIDES: [[i32; 3]; 2] = [[-1, 1, 0], [0, 1, -1]];
        let [c, r] = self.start();
        let (Some(c), Some(r)) = (c.checked_sub(BLOCK * block), r.checked_sub(BLOCK * block))
        else {
            return 0;
        };
        let side = |along: usize, line: usize| {
            let lines: Option<&[i32; 3]> = SIDES.get(along);
            lines
                .and_then(|lines| lines.get(line))
                .copied()
                .unwrap_or(0)
        };
        match self {
            Self::Across(_) => side(c, r),
            Self::Down(_) => side(r, c),
            Self::Brace(_) if c >= BLOCK || r >= BLOCK => 0,
            Self::Brace(_) => 1 - 2 * i32::from(c != r),
        }
    }
}

/// The position of a node in the plane; rows are numbered downwards.
fn place([c, r]: [usize; 2]) -> [f64; 2] {
    [c as f64, -(r as f64)]
}

impl Lattice {
    pub(super) fn new(n: usize, share: f64) -> Self {
        Self {
            n,
            braced: Share::of(n / BLOCK, share),
        }
    }

    fn n_rods(&self) -> usize {
        2 * self.n * (self.n + 1) + BRACES * self.braced.chosen
    }

    fn nodes(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let n = self.n;
        (0..=n).flat_map(move |r| (0..=n).map(move |c| [c, r]))
    }

    /// Whether a cell, identified by its first node, has a brace.
    fn is_braced(&self, [c, r]: [usize; 2]) -> bool {
        let block = c / BLOCK;
        block == r / BLOCK && block < self.n / BLOCK && self.braced.has(block)
    }

    /// Rods that start at a node.
    fn starting(&self, node: [usize; 2]) -> impl Iterator<Item = Rod> + use<> {
        let [c, r] = node;
        let across = (c < self.n).then_some(Rod::Across(node));
        let down = (r < self.n).then_some(Rod::Down(node));
        let brace = self.is_braced(node).then_some(Rod::Brace(node));
        [across, down, brace].into_iter().flatten()
    }

    /// Rods that meet at a node, with the sign of their direction away from the node. Rods that end
    /// at the node come first, then rods that start at the node.
    fn meeting(&self, node: [usize; 2]) -> Vec<(Rod, i32)> {
        let [c, r] = node;
        let left = c.checked_sub(1).map(|c| Rod::Across([c, r]));
        let above = r.checked_sub(1).map(|r| Rod::Down([c, r]));
        let corner = c.checked_sub(1).zip(r.checked_sub(1));
        let corner = corner
            .map(|(c, r)| [c, r])
            .filter(|&cell| self.is_braced(cell));
        let ending = [left, above, corner.map(Rod::Brace)].into_iter().flatten();
        let ending = ending.map(|rod| (rod, -1));
        ending
            .chain(self.starting(node).map(|rod| (rod, 1)))
            .collect()
    }

    /// Returns the undetermined part of the reaction of pin number `pin` (from 0) of a node. This
    /// is the sum of the self-stress tensions of the rods up to this pin.
    fn free(&self, [c, r]: [usize; 2], meeting: &[(Rod, i32)], pin: usize) -> Option<Free> {
        let near = [c / BLOCK, (c / BLOCK).wrapping_sub(1)];
        let blocks = near.into_iter().filter(|&block| {
            let first = BLOCK.saturating_mul(block);
            let touches = |k: usize| (first..=first.saturating_add(BLOCK)).contains(&k);
            block < self.n / BLOCK && self.braced.has(block) && touches(c) && touches(r)
        });
        let pulled = blocks.map(|block| {
            meeting[..=pin].iter().fold([0, 0], |[x, y], (rod, sign)| {
                let pull = sign * rod.pull(block);
                let [across, down] = rod.step();
                [x + pull * (across as i32), y - pull * (down as i32)]
            })
        });
        let pulled: Vec<[i32; 2]> = pulled.filter(|force| *force != [0, 0]).collect();
        match pulled[..] {
            [] => None,
            [[a, b], [c, d]] if a * d != b * c => Some(Free::Force),
            [[x, y], ..] => {
                let length = f64::from(x).hypot(f64::from(y));
                Some(Free::Along([f64::from(x) / length, f64::from(y) / length]))
            }
        }
    }
}

impl Family for Lattice {
    fn answer(&self) -> Answer {
        let (rods, nodes) = (self.n_rods(), (self.n + 1) * (self.n + 1));
        // A node has one pin less than it has rods, and the hook is one more joint.
        let joints = 2 * rods - nodes + 1;
        Answer::new(rods, joints, 0, 2 * joints, self.braced.chosen)
    }

    fn free_reactions(&self) -> Vec<FreeReaction> {
        let of_node = |node: [usize; 2]| {
            let meeting = self.meeting(node);
            let of_pin = |pin: usize| {
                let [c, r] = node;
                let free = self.free(node, &meeting, pin)?;
                Some(FreeReaction::new(format!("node-{c}-{r}-{pin}"), free))
            };
            (0..meeting.len() - 1)
                .filter_map(of_pin)
                .collect::<Vec<_>>()
        };
        self.nodes().flat_map(of_node).collect()
    }

    fn words(&self) -> Vec<String> {
        vec![
            format!(
                "{n} x {n} square cells of unit rods, hanging from a corner, {} blocks of 2 x 2 cells braced.",
                self.braced.chosen,
                n = self.n
            ),
            "Not unique: reactions inside braced blocks, in the directions in which their braces can press against each other."
                .to_owned(),
        ]
    }

    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()> {
        scene.scene(name, [0.0, -9.81])?;
        for node in self.nodes() {
            for rod in self.starting(node) {
                let [c, r] = node;
                let [across, down] = rod.step();
                let end = [c + across, r + down];
                let body = BodyText::rod(ROD_MASS, place(node), place(end));
                scene.body(rod.name(), &body)?;
            }
        }
        for node in self.nodes() {
            let ([c, r], meeting) = (node, self.meeting(node));
            if let ([0, 0], Some((first, _))) = (node, meeting.first()) {
                scene.revolute("hook", [&"ground", &first.name()], place(node))?;
            }
            for (pin, pair) in meeting.windows(2).enumerate() {
                let [(first, _), (second, _)] = pair else {
                    continue;
                };
                scene.revolute(
                    format_args!("node-{c}-{r}-{pin}"),
                    [&first.name(), &second.name()],
                    place(node),
                )?;
            }
        }
        scene.run_to(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tensions of a block are in equilibrium at every node.
    #[test]
    fn a_block_needs_no_load() {
        let lattice = Lattice::new(6, 1.0);
        for block in 0..3 {
            let mut stretched = 0;
            for node in lattice.nodes() {
                let mut sum = [0, 0];
                for (rod, sign) in lattice.meeting(node) {
                    let [across, down] = rod.step();
                    sum[0] += sign * rod.pull(block) * across as i32;
                    sum[1] += sign * rod.pull(block) * down as i32;
                    stretched += i32::from(rod.pull(block) != 0);
                }
                assert_eq!(sum, [0, 0], "node {node:?}, block {block}");
            }
            // There are four braces and eight sides, each counted at both ends.
            assert_eq!(stretched, 24);
        }
    }

    #[test]
    fn rows_and_freedoms_are_counted_twice() {
        for n in 1..20 {
            let lattice = Lattice::new(n, 1.0);
            let answer = lattice.answer();
            let pins = lattice.nodes().map(|node| lattice.meeting(node).len() - 1);
            assert_eq!(answer.joints, pins.sum::<usize>() + 1);
            // The test compares the number of degrees of freedom from the theory of braces with the
            // number of coordinates minus the number of independent rows.
            assert_eq!(answer.mobility, 2 * n - 3 * (n / 2));
        }
    }
}
