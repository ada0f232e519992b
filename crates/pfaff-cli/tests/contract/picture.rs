//! Tests pictures as PNG: the data that another program reads from them, and rejected requests.

use std::fs;
use std::io::Cursor;
use std::process::{Command, Output};

use serde_json::Value;
use suite::generate::Kind;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, generated, pfaff, stderr, stdout, with_scene};

/// Colours of the style sheet: strokes of joints by the verdict of their reactions.
const UNIQUE: [u8; 3] = [0x00, 0x72, 0xb2];
const NOT_UNIQUE: [u8; 3] = [0xc4, 0x4f, 0x00];
const UNDECIDED: [u8; 3] = [0xa3, 0x48, 0x7c];
const WHITE: [u8; 3] = [255; 3];

/// Data that another program reads from a picture.
struct Picture {
    bytes: Vec<u8>,
    size: [u32; 2],
    colours: Vec<[u8; 3]>,
    texts: Vec<[String; 2]>,
}

impl Picture {
    fn read(folder: &Folder, name: &str) -> Self {
        let bytes = fs::read(folder.0.join(name)).expect("a file");
        assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
        let decoder = png::Decoder::new(Cursor::new(&bytes));
        let mut reader = decoder.read_info().expect("a PNG file");
        let mut data = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut data).expect("pixels");
        reader.finish().expect("nothing is wrong behind them");
        let info = reader.info();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        let texts = info.uncompressed_latin1_text.iter();
        let texts = texts.map(|t| [t.keyword.clone(), t.text.clone()]).collect();
        let size = [info.width, info.height];
        let colours = data.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        Self {
            bytes,
            size,
            colours,
            texts,
        }
    }

    fn count(&self, colour: [u8; 3]) -> usize {
        self.colours.iter().filter(|c| **c == colour).count()
    }
}

fn place(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::create_dir_all(&folder.0).expect("writable");
    folder
}

/// Returns the size that the text of an SVG states (px).
fn stated_size(svg: &str) -> [f64; 2] {
    ["width", "height"].map(|side| {
        let (_, rest) = svg.split_once(&format!(" {side}=\"")).expect("a size");
        let (number, _) = rest.split_once('"').expect("an end");
        number.parse().expect("a number")
    })
}

/// Checks that the PNG for an SVG has two pixels for each of its px, and is not empty.
pub(super) fn is_the_figure(folder: &Folder, stem: &str) {
    let svg = stated_size(&folder.read(&format!("{stem}.svg")));
    let picture = Picture::read(folder, &format!("{stem}.png"));
    assert_eq!(picture.size, svg.map(|side| (2.0 * side).round() as u32));
    assert_eq!(picture.texts, [["Software", "pfaff"]]);
    let (white, all) = (picture.count(WHITE), picture.colours.len());
    assert!(
        white > all / 2 && white < all - all / 100,
        "{white} of {all}"
    );
}

fn refused(arguments: &[&str], message: &str) {
    let output = pfaff(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert!(said.contains(message), "{arguments:?}: {said}");
    assert!(!said.contains("panicked"), "{said}");
}

#[test]
fn the_robot_has_the_colours_of_its_verdicts() {
    let folder = place("picture-robot");
    let write = |name: &str| -> Output {
        let path = folder.0.join(name).display().to_string();
        let output = pfaff(&["view", ROBOT, "--out", &path, "--no-open"]);
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
        assert!(stdout(&output).ends_with(&format!("written to {path}\n")));
        output
    };
    for name in ["robot.svg", "robot.png", "again.PNG"] {
        write(name);
    }
    is_the_figure(&folder, "robot");
    let picture = Picture::read(&folder, "robot.png");
    for (colour, least) in [(UNIQUE, 2000), (NOT_UNIQUE, 2000), (UNDECIDED, 20)] {
        assert!(picture.count(colour) > least, "{colour:02x?}");
    }
    assert!(picture.bytes == Picture::read(&folder, "again.PNG").bytes);
    assert!(picture.bytes.len() < 300_000, "{}", picture.bytes.len());
    // A picture of this program is replaced, and no temporary file remains.
    write("robot.png");
    assert_eq!(fs::read_dir(&folder.0).expect("a folder").count(), 3);
}

#[test]
fn the_short_way_writes_beside_the_caller() {
    let folder = place("picture-here");
    let here = |arguments: &[&str]| -> Value {
        let output = Command::new(env!("CARGO_BIN_EXE_pfaff"))
            .args(["view", ROBOT, "--png", "--json"])
            .args(arguments)
            .current_dir(&folder.0)
            .output()
            .expect("the command starts");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_slice(&output.stdout).expect("one JSON document")
    };
    let document = here(&[]);
    let picture = Picture::read(&folder, "robot-trolley.png");
    assert_eq!(document["file"], "robot-trolley.png");
    assert_eq!(document["pixels"], serde_json::json!(picture.size));
    assert_eq!(document["bytes"], picture.bytes.len());
    assert_eq!(document.get("boxes"), None);
    let half = here(&["--scale", "0.5"]);
    assert_eq!(half["pixels"][0], 480);
    assert_eq!(Picture::read(&folder, "robot-trolley.png").size[0], 480);
}

#[test]
fn pictures_of_others_are_kept() {
    let folder = place("picture-foreign");
    let path = folder.0.join("photo.png");
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    let named = encoder.add_text_chunk("Software".to_owned(), "pfaffenhofen".to_owned());
    named.expect("a text");
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[1, 2, 3]).expect("a pixel");
    writer.finish().expect("an end");
    fs::write(&path, &bytes).expect("writable");
    let path = path.to_str().expect("UTF-8");
    let view = ["view", ROBOT, "--no-open", "--out", path];
    refused(&view, "was not written by pfaff");
    assert_eq!(fs::read(path).expect("it is there"), bytes);
    let output = pfaff(&[&view[..], &["--force"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(Picture::read(&folder, "photo.png").size[0] > 1);
}

#[test]
fn what_cannot_be_painted_is_refused_by_name() {
    let folder = place("picture-refused");
    let [png, svg] = ["x.png", "x.svg"].map(|name| folder.0.join(name).display().to_string());
    let scaled = |scale| ["view", ROBOT, "--no-open", "--out", &png, "--scale", scale];
    for scale in ["0", "-1", "nan", "inf", "1e-3", "20.5"] {
        refused(&scaled(scale), "need a number from 0.1 to 20");
    }
    refused(
        &scaled("20"),
        "at most 25 million are supported: use a scale up to 6.9",
    );
    refused(
        &["view", ROBOT, "--out", &svg, "--scale", "2"],
        "--scale is for PNG",
    );
    refused(&["view", ROBOT, "--out", &png, "--png"], "--png");
    assert_eq!(fs::read_dir(&folder.0).expect("a folder").count(), 0);
}

#[test]
fn names_of_any_language_and_length_are_painted() {
    let folder = place("picture-names");
    let path = folder.0.join("x.png").display().to_string();
    let view = |name: &str, more: &[&str]| {
        let scene = PENDULUM.replace("bob", name);
        let arguments = [&["view", "-", "--no-open", "--out", &path], more].concat();
        let output = with_scene(&arguments, &scene);
        let all = (output.status.code(), stderr(&output));
        assert_eq!(all, (Some(0), String::new()), "{name:?}");
        output
    };
    let quiet = |name: &str| {
        let said = stdout(&view(name, &[]));
        assert!(said.ends_with("x.png\n"), "{said}");
        Picture::read(&folder, "x.png")
    };
    let plain = quiet("bob");
    // The fonts of the program contain these letters, so no machine draws boxes.
    for name in ["κνώδαλο φ̇", "маятник", "ß ğ ő ł č ñ", "R₁² ≤ ∞"] {
        assert!(quiet(name).bytes != plain.bytes, "{name}");
    }
    let long = "a-very-long-name-of-a-body-".repeat(37);
    assert_eq!(quiet(&long).size, plain.size);
    for name in ["摆锤", "مطرقة", "🔨"] {
        assert!(view(name, &[]).stdout.len() > 50, "{name}");
    }
    // No font contains a character that is not assigned.
    let said = stdout(&view("b\u{378}b", &[]));
    let told = "x.png\nprinted as boxes, because no installed font has these characters: U+0378\n";
    assert!(said.ends_with(told), "{said}");
    let document = view("b\u{378}b", &["--json"]).stdout;
    let document: Value = serde_json::from_slice(&document).expect("one JSON document");
    assert_eq!(document["boxes"], "\u{378}");
}

#[test]
fn large_scenes_and_scenes_in_space_are_painted() {
    let folder = place("picture-large");
    let path = folder.0.join("x.png").display().to_string();
    let hexapod = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/hexapod.toml");
    let hexapod = fs::read_to_string(hexapod).expect("an example");
    for scene in [generated(Kind::Parallelograms, 120), hexapod] {
        let output = with_scene(&["view", "-", "--no-open", "--out", &path], &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let picture = Picture::read(&folder, "x.png");
        assert_eq!(picture.size[0], 1920);
        assert!(picture.count(UNIQUE) + picture.count(NOT_UNIQUE) > 2000);
    }
}
