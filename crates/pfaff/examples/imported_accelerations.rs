//! Accelerations of an imported model at its keyframes `state 0`, `state 1` and so on, or of a
//! scene at its start, for comparison with other programs:
//!
//! ```text
//! cargo run --release -p pfaff --example imported_accelerations -- arm.xml
//! cargo run --release -p pfaff --example imported_accelerations -- arm.toml
//! ```
//!
//! The output has one line for each body and state: the number of the state, the body, the position
//! and the acceleration of the mass centre, and the angular acceleration. Vectors are along the
//! axes of the ground. A scene has one state, with number 0.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use pfaff::dynamics::{MotionFault, Sample};
use pfaff::import::{Folder, Options, import};
use pfaff::model::Registry;
use pfaff::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("needs a file")?;
    let text = std::fs::read_to_string(&file)?;
    let registry = Registry::standard();
    if Path::new(&file)
        .extension()
        .is_some_and(|end| end == "toml")
    {
        return print_state(&file, &text, &registry, 0);
    }
    for number in 0.. {
        let options = Options {
            folder: Folder::of(Path::new(&file)),
            keyframe: Some(format!("state {number}")),
            ..Options::default()
        };
        match import(&file, &text, &options) {
            Ok(imported) => print_state(&file, &imported.scene, &registry, number)?,
            Err(_) if number > 0 => return Ok(()),
            Err(refusal) => return Err(format!("{:?}", refusal.diagnostics).into()),
        }
    }
    Ok(())
}

/// Prints the accelerations at the start of a scene, which is the state with this number.
fn print_state(
    file: &str,
    scene: &str,
    registry: &Registry,
    number: usize,
) -> Result<(), Box<dyn Error>> {
    let study = Study::read(file, scene, registry, &RunOptions::default());
    let study = study.map_err(|e| format!("state {number}: {e}\n{scene}"))?;
    let names: Vec<String> = study
        .prepared
        .mechanism
        .bodies()
        .iter()
        .map(|b| b.name.clone())
        .collect();
    let row = |sample: &mut Sample<'_, '_>| -> Result<ControlFlow<()>, MotionFault> {
        let a = sample.acceleration()?;
        for (k, name) in names.iter().enumerate() {
            let pose = &sample.q[7 * k..7 * k + 7];
            let spin = [a[6 * k + 3], a[6 * k + 4], a[6 * k + 5]];
            // The coordinates contain the quaternion of the principal axes. Angular velocities are
            // in these axes.
            let spin = times(&rotation(&pose[3..]), spin);
            let numbers = pose[..3].iter().chain(&a[6 * k..6 * k + 3]).chain(&spin);
            let numbers: Vec<String> = numbers.map(|x| format!("{x:?}")).collect();
            print(&format!("{number}\t{name}\t{}\n", numbers.join("\t")));
        }
        Ok(ControlFlow::Break(()))
    };
    study
        .run(&MotionOptions::to(1e-6), row)
        .map_err(|failure| failure.to_string())?;
    Ok(())
}

/// Standard output of a program for people and scripts.
#[allow(clippy::print_stdout)]
fn print(line: &str) {
    print!("{line}");
}

fn times(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The matrix of a quaternion (w, x, y, z).
fn rotation(e: &[f64]) -> [[f64; 3]; 3] {
    let n = e.iter().map(|x| x * x).sum::<f64>();
    let [w, x, y, z] = [e[0], e[1], e[2], e[3]];
    [
        [
            w * w + x * x - y * y - z * z,
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            w * w - x * x + y * y - z * z,
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            w * w - x * x - y * y + z * z,
        ],
    ]
    .map(|row| row.map(|entry| entry / n))
}
