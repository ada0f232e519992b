//! Imports files with random changes. Each file must be imported or rejected, and the reader of
//! scenes must be able to parse every imported scene. `PFAFF_FUZZ=100000` sets the number of files.

use model::Registry;
use pfaff_import::{Axes, Drives, Folder, Options};

use super::{path_of, text_of};

/// Number of changed files in an ordinary run.
const FEW: u64 = 600;

const FILES: [&str; 23] = [
    "mjcf/pendulum.xml",
    "mjcf/free-and-ball.xml",
    "mjcf/many-joints.xml",
    "mjcf/classes.xml",
    "mjcf/four-bar.xml",
    "mjcf/couplings.xml",
    "mjcf/bounds.xml",
    "mjcf/included.xml",
    "urdf/arm.urdf",
    "urdf/gripper.urdf",
    "urdf/four-bar.urdf",
    "urdf/triangle.urdf",
    "urdf/parallelogram.urdf",
    "urdf/floating.urdf",
    "urdf/chain.urdf",
    "sdf/four-bar.sdf",
    "sdf/rounded.sdf",
    "sdf/frames.sdf",
    "sdf/many-types.sdf",
    "sdf/old.sdf",
    "sdf/follows.sdf",
    "sdf/bare.sdf",
    "sdf/models.sdf",
];

/// Loop closures of one of the files.
const LOOPS: &str = "urdf/triangle.yaml";

/// Fragments of text that are inserted at random positions.
const PIECES: [&str; 38] = [
    "<",
    ">",
    "/>",
    "\"",
    "'",
    "&amp;",
    "&#0;",
    "&lol;",
    "0",
    "-1",
    "1e60",
    "1e-320",
    "nan",
    "-0.0",
    "0 0 0",
    "1 2 3 4 5 6 7",
    "<body>",
    "</body>",
    "<joint/>",
    "<joint type=\"ball\"/>",
    "<freejoint/>",
    "<geom size=\"1\"/>",
    "<frame/>",
    "<include file=\"parts/arm.xml\"/>",
    "<include><uri>bare.sdf</uri></include>",
    "<include merge=\"true\"><uri>follows.sdf</uri><placement_frame>a</placement_frame></include>",
    "<model name=\"door\">",
    "</model>",
    " name=\"hinge\"",
    " class=\"leg\"",
    " pos=\"0 0 0\"",
    " axis=\"0 0 0\"",
    " ref=\"1\"",
    "<!--",
    "-->",
    "<![CDATA[",
    "\u{0}",
    "φ\u{202e}",
];

/// A generator of pseudo-random numbers (xorshift64*).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33;
        usize::try_from(high).unwrap_or(0) % n.max(1)
    }
}

/// Returns a text with one to six changes: inserted fragments, deleted bytes, moved parts,
/// exchanged numbers.
fn changed(text: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(4) {
        let place = |text: &str, at: usize| text.floor_char_boundary(at);
        let a = place(&text, random.below(text.len() + 1));
        let b = place(&text, (a + random.below(40)).min(text.len()));
        match random.below(16) {
            0 => text.insert_str(a, PIECES[random.below(PIECES.len())]),
            1 => text.replace_range(a..b, ""),
            2 => text.replace_range(a..b, PIECES[random.below(PIECES.len())]),
            3 => {
                let piece = text[a..b].to_owned();
                let to = place(&text, random.below(text.len() + 1));
                text.insert_str(to, &piece);
            }
            // One quoted word is replaced by another: names, numbers and lists change their
            // positions.
            _ => {
                let words: Vec<(usize, usize)> = text
                    .match_indices('"')
                    .map(|(at, _)| at)
                    .collect::<Vec<_>>()
                    .chunks_exact(2)
                    .map(|pair| (pair[0] + 1, pair[1]))
                    .collect();
                if let (Some(&(a, b)), Some(&(c, d))) = (
                    words.get(random.below(words.len())),
                    words.get(random.below(words.len())),
                ) {
                    let piece = if random.below(3) == 0 {
                        PIECES[random.below(PIECES.len())].to_owned()
                    } else {
                        text[c..d].to_owned()
                    };
                    text.replace_range(a..b, &piece);
                }
            }
        }
    }
    text
}

#[test]
fn changed_files_are_imported_or_refused() {
    let count = std::env::var("PFAFF_FUZZ")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(FEW);
    let texts = FILES.map(|file| (file, text_of(file)));
    let registry = Registry::standard();
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut imported, mut read) = (0_u64, 0_u64);
    for k in 0..count {
        let (file, text) = &texts[random.below(texts.len())];
        let text = changed(text, &mut random);
        let folder = Folder::of(std::path::Path::new(&path_of(file)));
        let keyframe =
            (k % 5 == 0 && k % 7 != 0 && text.contains("name=\"up\"")).then(|| "up".to_owned());
        let loops = file.ends_with("triangle.urdf").then(|| {
            let yaml = text_of(LOOPS);
            let yaml = if k % 2 == 0 {
                yaml
            } else {
                changed(&yaml, &mut random)
            };
            (LOOPS.to_owned(), yaml)
        });
        let asked = [("A", 0.5), ("left", 0.01), ("thumb", 40.0), ("hinge", -1.0)];
        let pose = asked
            .iter()
            .filter(|(name, _)| k % 7 == 0 && text.contains(&format!("name=\"{name}\"")));
        let pose: Vec<(String, f64)> = pose.map(|(name, q)| ((*name).to_owned(), *q)).collect();
        let axes = if k % 3 == 0 {
            Axes::Snapped
        } else {
            Axes::Told
        };
        let drives = Drives::ALL[random.below(Drives::ALL.len())];
        match pfaff_import::import(
            file,
            &text,
            &Options {
                folder,
                keyframe,
                loops,
                axes,
                pose,
                drives,
                ..Options::default()
            },
        ) {
            Ok(done) => {
                imported += 1;
                match scene::read("changed.toml", &done.scene, &registry) {
                    Ok(_) => read += 1,
                    // A scene may contain errors of mechanics, but no syntax errors.
                    Err(problems) => {
                        let of_form = [
                            "P0101", "P0102", "P0103", "P0105", "P0106", "P0108", "P0109", "P0127",
                            "P0135", "P0137", "P0138",
                        ];
                        let wrong = problems
                            .iter()
                            .find(|p| of_form.contains(&p.code.to_string().as_str()));
                        assert!(wrong.is_none(), "{wrong:?}\n{text}\n{}", done.scene);
                    }
                }
            }
            Err(refusal) => assert!(!refusal.diagnostics.is_empty(), "{text}"),
        }
    }
    assert!(
        imported > count / 20 && read > count / 40,
        "{imported} imported, {read} read of {count}"
    );
}
