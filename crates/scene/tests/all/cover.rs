//! Tests the keys of `[scene]` for the title of a report, and `print` and `plots` of `[output]`.

use model::Registry;
use pfaff_scene::{Cover, PlotRequest, PrintStyle, Scene, read};

/// A pendulum with these lines in `[scene]` and these other lines.
fn scene(keys: &str, rest: &str) -> Result<Scene, String> {
    let text = format!(
        "[scene]\nname = \"pendulum\"\nspace = \"plane\"\n{keys}\n\
         [[body]]\nname = \"bob\"\nmass = 1.0\ninertia = 0.1\nposition = [1.0, 0.0]\n\
         [[joint]]\nname = \"pivot\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bob\"]\nat = [0.0, 0.0]\n{rest}"
    );
    read("pendulum.toml", &text, &Registry::standard())
        .map_err(|problems| problems.iter().map(|p| format!("{} {p}", p.code)).collect())
}

fn text(text: &str) -> Option<String> {
    Some(text.to_owned())
}

#[test]
fn a_title_is_text_of_one_line() {
    let keys = "title = \" Loads of the pivot \"\nauthor = \"A. B.\"\nproject = \"\"";
    let read = scene(keys, "").expect("a scene");
    let expected = Cover {
        title: text("Loads of the pivot"),
        author: text("A. B."),
        ..Cover::default()
    };
    assert_eq!(read.output.cover, expected);
    assert_eq!(
        scene("", "").expect("a scene").output.cover,
        Cover::default()
    );
    let long = format!("date = \"{}\"", "x".repeat(201));
    for (keys, words) in [
        ("title = \"a\\nb\"", "P0108"),
        ("title = \"a\\nb\"", "texts of a title are of one line"),
        ("date = 2026-01-01", "a text of one line, in quotes"),
        (long.as_str(), "has 201 letters, more than 200"),
    ] {
        let refused = scene(keys, "").expect_err(keys);
        assert!(refused.contains(words), "{refused}");
    }
    let longest = format!("date = \"{}\"", "é".repeat(200));
    assert!(scene(&longest, "").is_ok());
}

#[test]
fn plots_are_lists_of_names_or_tables() {
    let rest = "[output]\nprint = \"customer\"\nplots = [[\"pivot.Fx\", \"pivot.Fy\", \"pivot.Fx\"], { title = \"way\", curves = [\"bob.x\"] }]";
    let output = scene("", rest).expect("a scene").output;
    assert_eq!(output.print, PrintStyle::Customer);
    let plot = |title: Option<&str>, curves: &[&str]| PlotRequest {
        title: title.map(str::to_owned),
        curves: curves.iter().map(|name| (*name).to_owned()).collect(),
    };
    let expected = [
        plot(None, &["pivot.Fx", "pivot.Fy"]),
        plot(Some("way"), &["bob.x"]),
    ];
    assert_eq!(output.plots, expected);
    assert_eq!(
        scene("", "").expect("a scene").output.print,
        PrintStyle::Full
    );
    for (value, words) in [
        ("plots = [[]]", "P0150"),
        ("plots = [{ title = \"x\" }]", "needs the key `curves`"),
        ("plots = [{ curves = [\"bob.x\"], titel = \"x\" }]", "titel"),
        ("plots = [\"bob.x\"]", "a list of names of columns"),
        ("plots = [[1]]", "the name of a column"),
        ("print = \"custom\"", "`print` `custom` is unknown"),
    ] {
        let refused = scene("", &format!("[output]\n{value}")).expect_err(value);
        assert!(refused.contains(words), "{refused}");
    }
}
