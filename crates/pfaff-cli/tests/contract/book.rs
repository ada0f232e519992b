//! The book shows the actual output of the command: every `console` block of `docs/book` is run and
//! compared line by line, every `toml` block is read. Blocks of Rust are doc tests of the package
//! `tests`.
//!
//! - A `toml` block that begins with `# NAME.toml` is a scene; `toml,wrong` marks a scene that
//!   `pfaff check` rejects. A block `toml,fragment,NAME.toml` is added to that scene.
//! - A `console` block has lines `$ COMMAND` with the output below. A line `…` represents any
//!   lines. Commands are run in sequence, each chapter in its own folder, which contains all scenes
//!   of the book and the robot. The available commands are `pfaff` (also after `|`), `ls`,
//!   `head -n`, and the scenes that the laboratory generates
//!   (`cargo run -q --release -p lab -- generate`); other output of the laboratory is compared by
//!   its own tests.

use std::fs;
use std::path::Path;

use suite::generate::Kind;

use super::{Folder, ROBOT, generated, stderr, stdout, with_scene};

const BOOK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book");

/// Represents omitted lines.
const LEFT_OUT: &str = "…";

struct Block {
    chapter: String,
    /// Line of its opening fence, from 1.
    line: usize,
    info: Vec<String>,
    text: String,
}

impl Block {
    fn is(&self, word: &str) -> bool {
        self.info.iter().any(|w| w == word)
    }

    /// Returns the name of the file that the block contains, if its first line states it.
    fn file(&self) -> Option<&str> {
        let name = self.text.lines().next()?.strip_prefix("# ")?;
        name.ends_with(".toml").then_some(name)
    }

    fn place(&self) -> String {
        format!("docs/book/{}:{}", self.chapter, self.line)
    }
}

/// Returns all blocks of all chapters, by chapter.
fn blocks() -> Vec<Block> {
    let entries = fs::read_dir(BOOK).expect("the book is there").flatten();
    let mut chapters: Vec<_> = entries
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
        .collect();
    chapters.sort();
    let mut found = Vec::new();
    for path in chapters {
        let chapter = path.file_name().expect("a file").to_string_lossy();
        let text = fs::read_to_string(&path).expect("readable");
        let mut open: Option<Block> = None;
        for (k, line) in text.lines().enumerate() {
            match (&mut open, line.strip_prefix("```")) {
                (Some(_), Some("")) => found.extend(open.take()),
                (Some(block), _) => {
                    block.text += line;
                    block.text.push('\n');
                }
                (None, Some(info)) => {
                    open = Some(Block {
                        chapter: chapter.to_string(),
                        line: k + 1,
                        info: info.split(',').map(str::to_owned).collect(),
                        text: String::new(),
                    });
                }
                (None, None) => {}
            }
        }
        assert!(open.is_none(), "{chapter} ends within a block");
    }
    found
}

#[test]
fn every_scene_and_every_fragment_is_read() {
    let blocks = blocks();
    let scenes: Vec<&Block> = blocks.iter().filter(|b| b.file().is_some()).collect();
    let mut seen = 0;
    for block in blocks.iter().filter(|b| b.is("toml")) {
        let text = if block.is("fragment") {
            let frame = block.info.last().map(String::as_str);
            let frame = scenes.iter().find(|s| s.file() == frame);
            let frame = frame.unwrap_or_else(|| panic!("{}: no such frame", block.place()));
            format!("{}\n{}", frame.text, block.text)
        } else {
            let named = scenes.iter().filter(|s| s.file() == block.file()).count();
            assert_eq!(named, 1, "{}: a scene has one name", block.place());
            block.text.clone()
        };
        let output = with_scene(&["check", "-"], &text);
        let refused = !output.status.success();
        let problem = stderr(&output);
        assert_eq!(refused, block.is("wrong"), "{}: {problem}", block.place());
        seen += 1;
    }
    assert!(seen > 30, "{seen} blocks");
}

#[test]
fn every_command_writes_what_the_book_shows() {
    let blocks = blocks();
    let mut folder: Option<(String, Folder)> = None;
    let mut wrong = String::new();
    for block in blocks.iter().filter(|b| b.is("console")) {
        if folder.as_ref().is_none_or(|(c, _)| *c != block.chapter) {
            folder = Some((block.chapter.clone(), with_all_scenes(&blocks, block)));
        }
        let (_, folder) = folder.as_ref().expect("just made");
        for example in block.text.split("$ ").skip(1) {
            let (command, shown) = example.split_once('\n').expect("a line ends");
            let Some(written) = run(command, &folder.0) else {
                continue;
            };
            let lines = |text: &str| -> Vec<String> {
                text.lines().map(|l| l.trim_end().to_owned()).collect()
            };
            let (shown, written) = (lines(shown), lines(&written));
            if !agree(&shown, &written) {
                wrong += &format!(
                    "\n{}: $ {command}\n--- written:\n{}\n--- shown:\n{}\n",
                    block.place(),
                    written.join("\n"),
                    shown.join("\n")
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Creates a folder for the examples of a chapter.
fn with_all_scenes(blocks: &[Block], chapter: &Block) -> Folder {
    let folder = Folder::new(&format!("book-{}", chapter.chapter));
    fs::create_dir_all(&folder.0).expect("a folder");
    for block in blocks {
        if let Some(name) = block.file() {
            fs::write(folder.0.join(name), &block.text).expect("written");
        }
    }
    fs::copy(ROBOT, folder.0.join("robot-trolley.toml")).expect("the robot is there");
    folder
}

/// Returns the output of a command of a block, with errors at the end. The output of a rejected
/// command ends with the reason. It is `None` for a command of the laboratory.
fn run(command: &str, folder: &Path) -> Option<String> {
    let words = words(command);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    Some(match words.as_slice() {
        ["ls", directory] => {
            let entries = fs::read_dir(folder.join(directory)).expect("a directory");
            let mut names: Vec<String> = entries
                .flatten()
                .map(|e| e.file_name().to_string_lossy().into_owned())
                .collect();
            names.sort();
            names.join("\n")
        }
        ["head", "-n", count, file] => {
            let text = fs::read_to_string(folder.join(file)).expect("a file");
            let count = count.parse().expect("a number");
            text.lines().take(count).collect::<Vec<_>>().join("\n")
        }
        ["pfaff", arguments @ ..] => {
            let output = command_in(folder, arguments);
            let text = stdout(&output) + &stderr(&output);
            let refused = text.lines().any(|l| l.starts_with("error[P"));
            // The available output is shown, and missing output is reported.
            let has_gaps = text.contains(" missing: ");
            let is_whole = !refused && !has_gaps;
            assert_eq!(output.status.success(), is_whole, "{command}: {output:?}");
            text
        }
        [
            "cargo",
            "run",
            "-q",
            "--release",
            "-p",
            "lab",
            "--",
            arguments @ ..,
        ] => {
            return of_laboratory(arguments, folder);
        }
        other => panic!("no example can run {other:?}"),
    })
}

/// Writes a generated scene, or passes it to a command and returns the output of that command.
fn of_laboratory(arguments: &[&str], folder: &Path) -> Option<String> {
    let ["generate", kind, "--n", n, rest @ ..] = arguments else {
        return None;
    };
    let kind = Kind::ALL.iter().find(|known| known.name() == *kind);
    let scene = generated(*kind.expect("a family"), n.parse().expect("a number"));
    match rest {
        ["--out", file] => {
            fs::write(folder.join(file), scene).expect("written");
            None
        }
        ["|", "pfaff", next @ ..] => {
            let output = with_scene(next, &scene);
            Some(stdout(&output) + &stderr(&output))
        }
        other => panic!("no example generates {other:?}"),
    }
}

fn command_in(folder: &Path, arguments: &[&str]) -> std::process::Output {
    std::process::Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the command starts")
}

/// Returns the words of a command, separated by blanks; a quoted word may contain blanks.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in command.chars() {
        match c {
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().expect("one word at least").push(c),
        }
    }
    words
}

/// Whether lines agree, with any lines in place of [`LEFT_OUT`].
fn agree(shown: &[String], written: &[String]) -> bool {
    match shown.split_first() {
        None => written.is_empty(),
        Some((line, rest)) if line.trim() == LEFT_OUT => {
            (0..=written.len()).any(|k| agree(rest, &written[k..]))
        }
        Some((line, rest)) => written.first() == Some(line) && agree(rest, &written[1..]),
    }
}

#[test]
fn lines_that_are_left_out_may_be_any_and_no_others() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let written = lines("a\nb\nc\nd");
    for right in ["a\nb\nc\nd", "…\nd", "a\n…", "a\n…\nc\n…", "…\na\nb\nc\nd"] {
        assert!(agree(&lines(right), &written), "{right}");
    }
    for wrong in ["a\nb\nc", "a\n…\nb", "b\n…", "…\nc", "a\nb\nc\nd\ne"] {
        assert!(!agree(&lines(wrong), &written), "{wrong}");
    }
}
