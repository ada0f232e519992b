//! A row of copies of the robot with its trolley. A spring with a damper couples the platforms of
//! neighbours.
//!
//! Forces do not change the rank: each copy has 21 coordinates, 22 rows, rank 20, and the same
//! unique reactions as the single robot. All copies have the same initial state and the same
//! steering, so the lengths of the springs are constant, and every copy moves like the single
//! robot.

use std::io;

use crate::cases::ROBOT;

use super::answer::{Answer, Free, FreeReaction};
use super::family::Family;
use super::text::SceneText;

/// Joints of the robot whose reactions are not unique in straight motion. Only the component
/// perpendicular to the direction of travel is not unique.
const NOT_UNIQUE: [&str; 6] = ["B", "C", "W1", "W2", "W3", "W4"];

/// Distance between neighbours (m).
const DISTANCE: f64 = 1.5;

pub(super) struct Fleet {
    n: usize,
    /// The tables of bodies, joints and drives of the robot.
    robot: Vec<Piece>,
}

/// A part of the text of the robot.
#[derive(Debug)]
enum Piece {
    /// Text that is the same in each copy.
    Text(&'static str),
    /// The beginning of a name.
    Name,
    /// A number that increases from copy to copy.
    Y(f64),
}

impl Fleet {
    pub(super) fn new(n: usize) -> Self {
        let tables = ROBOT.split_inclusive('\n');
        let tables = tables.skip_while(|line| !line.starts_with("[["));
        let tables = tables.take_while(|line| !line.starts_with("[simulate]"));
        let lines = tables.filter(|line| !line.starts_with('#'));
        let mut robot = Vec::new();
        lines.for_each(|line| take_apart(line, &mut robot));
        Self { n, robot }
    }
}

/// Finds the names in a line, and the y coordinates of global points.
fn take_apart(line: &'static str, out: &mut Vec<Piece>) {
    let key = line.split(' ').next().unwrap_or_default();
    match key {
        "name" | "bodies" | "body" | "joint" => {
            for (k, part) in line.split_inclusive('"').enumerate() {
                out.push(Piece::Text(part));
                // After an opening quotation mark.
                if k % 2 == 0 && part.ends_with('"') {
                    out.push(Piece::Name);
                }
            }
        }
        "position" | "at" => {
            let point = line.split_once(", ").and_then(|(before, after)| {
                let (y, rest) = after.split_once(']')?;
                Some((&line[..before.len() + 2], y.parse().ok()?, rest))
            });
            match point {
                Some((before, y, rest)) => {
                    out.extend([Piece::Text(before), Piece::Y(y), Piece::Text("]")]);
                    out.push(Piece::Text(rest));
                }
                None => out.push(Piece::Text(line)),
            }
        }
        _ => out.push(Piece::Text(line)),
    }
}

impl Family for Fleet {
    fn answer(&self) -> Answer {
        let n = self.n;
        Answer::new(7 * n, 13 * n, n, 22 * n, 2 * n)
    }

    fn free_reactions(&self) -> Vec<FreeReaction> {
        let across = Free::Along([0.0, 1.0]);
        let of_robot =
            |k: usize| NOT_UNIQUE.map(|joint| FreeReaction::new(format!("r{k}.{joint}"), across));
        (1..=self.n).flat_map(of_robot).collect()
    }

    fn words(&self) -> Vec<String> {
        vec![
            format!("{} robots with trolleys side by side, platforms coupled by springs.", self.n),
            "Not unique: B, C, W1, W2, W3, W4 of each robot, only while the robot drives straight and perpendicular to the coupling springs."
                .to_owned(),
            "All robots perform the same motion: the springs stay slack, and each robot moves as in robot-trolley.toml."
                .to_owned(),
        ]
    }

    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()> {
        scene.scene(name, [0.0; 2])?;
        scene.raw("\n")?;
        for k in 1..=self.n {
            let y_0 = DISTANCE * (k - 1) as f64;
            for piece in &self.robot {
                match piece {
                    Piece::Text(text) => scene.raw(text)?,
                    Piece::Name => scene.display(format_args!("r{k}."))?,
                    Piece::Y(y) => scene.display(format_args!("{:?}", y_0 + y))?,
                }
            }
        }
        for k in 1..self.n {
            let y = DISTANCE * k as f64;
            scene.display(format_args!(
                "[[force]]\nname = \"spring-{k}\"\ntype = \"spring-damper\"\n\
                 bodies = [\"r{k}.platform\", \"r{next}.platform\"]\nat = [[0.0, {below:?}], [0.0, {y:?}]]\n\
                 stiffness = 100.0\ndamping = 10.0\n\n",
                next = k + 1,
                below = y - DISTANCE
            ))?;
        }
        scene.raw("[simulate]\nt_end = 10.0\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that every name and every point is found. The test fails if the file of the robot is
    /// changed in a way that this module does not handle.
    #[test]
    fn the_robot_is_taken_apart() {
        let fleet = Fleet::new(1);
        let count = |is: fn(&Piece) -> bool| fleet.robot.iter().filter(|piece| is(piece)).count();
        // The file has 21 names of elements. Eight joints refer to two bodies, five joints refer to
        // one body, and the drive refers to its joint.
        assert_eq!(count(|piece| matches!(piece, Piece::Name)), 21 + 16 + 5 + 1);
        // There are seven bodies and thirteen joints.
        assert_eq!(count(|piece| matches!(piece, Piece::Y(_))), 7 + 13);
        let text: String = fleet
            .robot
            .iter()
            .map(|piece| match piece {
                Piece::Text(text) => (*text).to_owned(),
                Piece::Name => String::new(),
                Piece::Y(y) => format!("{y:?}"),
            })
            .collect();
        let without_comments: String = ROBOT
            .split_inclusive('\n')
            .filter(|line| !line.starts_with('#'))
            .collect();
        assert!(without_comments.contains(text.trim()), "{text}");
    }
}
