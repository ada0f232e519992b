//! Tests the suppression of warnings.

use super::read;

/// A scene with two kinds of warnings.
fn scene(silence: &str) -> String {
    format!(
        "[scene]\nname = \"bar\"\nspace = \"plane\"\ngravity = [0.0, -9810.0]\n{silence}\n\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\nangle = 45.0\n"
    )
}

fn codes(silence: &str) -> Vec<String> {
    let read = read(&scene(silence)).unwrap_or_else(|problems| panic!("{problems:#?}"));
    read.warnings.iter().map(|w| w.code.to_string()).collect()
}

#[test]
fn each_warning_is_silenced_by_its_code() {
    assert_eq!(codes(""), ["P0193", "P0192"]);
    assert_eq!(codes("silence = []"), ["P0193", "P0192"]);
    assert_eq!(codes("silence = [\"P0192\"]"), ["P0193"]);
    assert_eq!(codes("silence = [\"P0193\"]"), ["P0192"]);
    assert!(codes("silence = [\"P0193\", \"P0192\"]").is_empty());
    // If the scene has no warning with this code, the entry has no effect.
    assert_eq!(codes("silence = [\"P0197\"]"), ["P0193", "P0192"]);
}

#[test]
fn codes_that_are_no_warnings_are_errors_at_their_place() {
    for (written, message, help) in [
        (
            "\"P0102\"",
            "`[scene]`: `silence` contains `P0102`, which is not a warning of a scene",
            "did you mean `P0192`?",
        ),
        (
            "\"degrees\"",
            "`[scene]`: `silence` contains `degrees`, which is not a warning of a scene",
            "there are `P0186`, `P0187`, `P0188`, `P0189`, `P0190`, `P0191`, `P0192`, `P0193`, `P0194`, `P0195`, `P0196`, `P0197`, `P0198`, `P0199`",
        ),
        (
            "192",
            "`[scene]`: `silence` must be a list of codes of warnings [\"P0192\", …], found the number 192",
            "",
        ),
    ] {
        let text = scene(&format!("silence = [{written}]"));
        let problems = read(&text).expect_err("an error");
        assert_eq!(problems.len(), 1, "{problems:#?}");
        let found = &problems[0];
        assert_eq!(&text[found.primary.span.clone()], written);
        assert_eq!(found.message, message);
        assert_eq!(found.help.as_deref().unwrap_or_default(), help);
    }
    let problems = read(&scene("silence = \"P0192\"")).expect_err("an error");
    assert_eq!(problems[0].code.to_string(), "P0105");
}

/// If every body contains the same mistake, it is reported ten times, and the rest is counted.
#[test]
fn many_warnings_are_counted() {
    let body =
        |k: usize| format!("\n[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = 0.1\nangle = 90\n");
    let bodies: String = (0..1000).map(body).collect();
    let text = format!("{}{bodies}", scene(""));
    let found = read(&text).expect("a scene").warnings;
    assert_eq!(found.len(), 1 + 10);
    let last = &found[10];
    assert!(
        last.message.starts_with("body `b8`: `angle` is 90 rad"),
        "{last}"
    );
    assert!(last.message.ends_with("(and 991 more like this)"), "{last}");
}
