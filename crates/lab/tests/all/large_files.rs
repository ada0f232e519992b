//! Tests that large files, and files that are malicious because of their size, are read in time
//! proportional to their size or rejected with an error that states the limit.

use std::fmt::Write;
use std::time::{Duration, Instant};

use model::start::{assemble, consistent_velocity};
use model::{Mechanism, Registry, StartOptions, System, Work};
use pfaff::scene::{Diagnostic, Scene, Severity};
use suite::generate::{Kind, Order};

/// Number of cells of a chain with a hundred thousand revolute joints.
const CELLS: usize = 18_750;

/// Time limit for any of these files, on a slow machine, without optimisation. An algorithm of
/// quadratic time would need hours.
const PATIENCE: Duration = Duration::from_secs(60);

/// Number of problems that are listed. One more message states the number of the remaining
/// problems.
const LISTED: usize = 5000;

/// Reads a text with the standard joints and forces.
fn read(text: &str) -> Result<Scene, Vec<Diagnostic>> {
    pfaff::scene::read("x.toml", text, &Registry::standard())
}

/// Returns a chain of parallelograms.
fn chain(cells: usize) -> String {
    let mut out = Vec::new();
    let generator = Order::of(Kind::Parallelograms, cells).generate();
    let written = generator.expect("a possible size").write(&mut out);
    written.expect("memory takes everything");
    String::from_utf8(out).expect("UTF-8")
}

/// Returns the problems of a text, found within the time limit.
fn problems(text: &str) -> Vec<Diagnostic> {
    let begin = Instant::now();
    let problems = read(text).expect_err("something is wrong");
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    problems
}

/// Returns the line, from 1, of the last occurrence of a text.
fn last_line(text: &str, what: &str) -> usize {
    let at = text.rfind(what).expect("it occurs");
    text[..at].matches('\n').count() + 1
}

#[test]
fn a_hundred_thousand_joints_are_read_and_started_without_a_matrix() {
    let text = chain(CELLS);
    let begin = Instant::now();
    let scene = read(&text).unwrap_or_else(|problems| panic!("{}", problems[0]));
    let d = scene.description.plane().expect("a planar scene");
    assert_eq!((d.bodies.len(), d.joints.len()), (68_750, 100_000));
    // The position of every table is stored. The last joint is the second to last table.
    let source = scene.source.as_ref().expect("places");
    let last = source.joints.last().expect("a joint");
    assert!(text[last.name_span()].starts_with("\"top-18749-"));
    let mut mechanism = Mechanism::build(d).expect("what is read can be built");
    // A dense matrix would have 4e10 entries.
    let start = StartOptions::default();
    let assembly = assemble(&mut mechanism, &start).expect("it is assembled already");
    assert!(assembly.correction.iter().all(|x| *x == 0.0));
    let all: Vec<usize> = (0..mechanism.layout().rows()).collect();
    let mut given = mechanism.frames().given_velocities(&assembly.q);
    let found = consistent_velocity(&mechanism, &start, &assembly.q, &given, &all);
    let found = found.expect("it rests");
    assert!(found.v.iter().all(|v| *v == 0.0));
    // The velocity of one body is given, and the velocities of the other bodies follow. In a chain
    // of parallelograms, the neighbouring bodies have the same velocity.
    given[0] = Some(1.0);
    let found = consistent_velocity(&mechanism, &start, &assembly.q, &given, &all);
    let found = found.expect("the chain moves so");
    assert_eq!(found.v[0], 1.0);
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &assembly.q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let misses = |i: usize| mechanism.layout().velocity_residual(&s, i, &found.v).abs();
    let worst = (0..mechanism.layout().rows())
        .map(misses)
        .fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst:e}");
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
}

#[test]
fn one_fault_in_a_hundred_thousand_joints_is_named() {
    let text = chain(CELLS);
    let at = text
        .rfind("\"crank-18700-1\", ")
        .expect("a joint with this crank");
    let mut wrong = text.clone();
    wrong.replace_range(at..at + 15, "\"crnak-18700-1\"");
    let line = last_line(&wrong, "crnak-18700-1");
    let found = problems(&wrong);
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].to_string(),
        format!(
            "x.toml:{line}:11: error: joint `top-18700-1` refers to the unknown body `crnak-18700-1`"
        )
    );
    assert_eq!(
        found[0].help.as_deref(),
        Some("did you mean `crank-18700-1`?")
    );

    let (before, after) = text.rsplit_once("inertia = ").expect("a body");
    let (_, after) = after.split_once('\n').expect("more lines");
    let missing = format!("{before}{after}");
    let line = last_line(&missing, "[[body]]");
    let found = problems(&missing);
    assert_eq!(found.len(), 1);
    let message = found[0].to_string();
    assert!(
        message.starts_with(&format!("x.toml:{line}:1: error: body `"))
            && message.ends_with("needs the key `inertia`: a number ≥ 0"),
        "{message}"
    );
}

/// The same mistake is in every joint. The first mistakes are listed, and the remaining ones are
/// counted.
#[test]
fn a_fault_in_every_joint_is_listed_some_thousand_times() {
    let text = chain(4000);
    let joints = text.matches("[[joint]]").count();
    for (from, to, piece, n) in [
        (
            "\"coupler-",
            "\"cuopler-",
            "refers to the unknown body",
            None,
        ),
        ("type = ", "tpye = ", "needs the key `type`", Some(joints)),
        (
            "\"revolute\"",
            "\"revolut\"",
            "has the unknown type `revolut`",
            Some(joints),
        ),
        (
            "at = [",
            "at = [nan, ",
            "must be a global point",
            Some(joints),
        ),
        (
            "at = [",
            "at = [[], ",
            "must be a global point",
            Some(joints),
        ),
    ] {
        let (before, after) = text.split_once("[[joint]]").expect("joints");
        let wrong = format!("{before}[[joint]]{}", after.replace(from, to));
        let found = problems(&wrong);
        assert_eq!(found.len(), LISTED + 1, "{from}");
        let has_piece = |d: &Diagnostic| d.message.contains(piece);
        assert!(
            found.iter().filter(|d| has_piece(d)).count() >= LISTED / 2,
            "{:?}",
            found[0]
        );
        assert_eq!(found[LISTED].severity, Severity::Note);
        let last = &found[LISTED].message;
        if let Some(n) = n {
            let expected = format!(
                "and {} more problems: only the first 5000 are listed",
                n - LISTED
            );
            assert_eq!(*last, expected);
        }
        assert!(
            last.ends_with("more problems: only the first 5000 are listed"),
            "{last}"
        );
    }
}

#[test]
fn names_that_are_all_alike_and_bodies_with_themselves() {
    let text = chain(4000);
    let mut alike = String::new();
    let mut itself = String::new();
    for line in text.lines() {
        match line.split_once(" = ") {
            Some(("name", _)) if !line.contains("parallelograms") => {
                alike.push_str("name = \"same\"\n");
                itself.push_str(line);
            }
            Some(("bodies", _)) => {
                alike.push_str("bodies = [\"ground\", \"same\"]\n");
                itself.push_str("bodies = [\"coupler-7\", \"coupler-7\"]");
            }
            _ => {
                alike.push_str(line);
                alike.push('\n');
                itself.push_str(line);
            }
        }
        itself.push('\n');
    }
    let found = problems(&alike);
    assert_eq!(found.len(), LISTED + 1);
    assert_eq!(found[0].message, "the name `same` is used twice");
    let found = problems(&itself);
    assert_eq!(found.len(), LISTED + 1);
    assert!(
        found[0]
            .message
            .ends_with("connects `coupler-7` with itself"),
        "{}",
        found[0]
    );
}

/// The scene is a chain of sliders, each mounted on the previous one. Each slider is driven, listed
/// in `keep` and in a group, and used in an expression.
#[test]
fn a_thing_of_every_kind_for_each_body() {
    const N: usize = 20_000;
    let mut text = "[scene]\nname = \"tower\"\nspace = \"plane\"\n".to_owned();
    let mut add = |line: std::fmt::Arguments| text.write_fmt(line).expect("memory");
    for k in 0..N {
        add(format_args!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = 1.0\n"
        ));
        let below = match k {
            0 => "ground".to_owned(),
            _ => format!("b{}", k - 1),
        };
        add(format_args!(
            "[[joint]]\nname = \"j{k}\"\ntype = \"translational\"\nbodies = [\"{below}\", \"b{k}\"]\nat = [0.0, 0.0]\naxis = [1.0, 0.0]\n\
             [[drive]]\nname = \"d{k}\"\njoint = \"j{k}\"\ntype = \"displacement\"\nmotion = 0.0\n\
             [[group]]\nname = \"g{k}\"\ncombine = \"j{k}.Fx - 2*d{k}.Fy + j{}.Fx\"\n",
            N - 1 - k
        ));
    }
    let list = |mut item: Box<dyn FnMut(usize) -> String>| {
        (0..N).map(|k| item(k) + ",\n").collect::<String>()
    };
    add(format_args!(
        "[output]\nreactions = [{}]\n",
        list(Box::new(|k| format!("\"d{k}\"")))
    ));
    add(format_args!(
        "[start]\nkeep = [{}]\n",
        list(Box::new(|k| format!("\"b{k}.angle\"")))
    ));
    add(format_args!(
        "[simulate]\nt_end = 1.0\ndrop = [{}]\n",
        list(Box::new(|k| format!("{}", k + 1)))
    ));
    // The sum of all components is one expression of several lines, which is allowed.
    let sum: String = (0..N).map(|k| format!(" + j{k}.Fx\n")).collect();
    add(format_args!(
        "[[group]]\nname = \"all\"\ncombine = \"\"\"{sum}\"\"\"\n"
    ));
    let begin = Instant::now();
    let scene = read(&text).unwrap_or_else(|problems| panic!("{}", problems[0]));
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    assert_eq!(scene.groups.len(), N + 1);
    assert_eq!(scene.start.keep.len(), N);
    let mechanism = Mechanism::build(&scene.description).expect("what is read can be built");
    assert_eq!(Work::of(&mechanism).without_turning.len(), N);
}

/// Number of levels of a malicious nesting. Each level needs only one byte in the file, but a
/// recursive reader would overflow any stack.
const DEEP: usize = 1_000_000;

#[test]
fn deep_nests_are_refused() {
    let head = "[scene]\nname = \"deep\"\nspace = \"plane\"\n";
    let wide = DEEP / 1000;
    for (what, nest) in [
        ("lists", format!("x = {}", "[".repeat(DEEP))),
        (
            "closed lists",
            format!("x = {}{}", "[".repeat(DEEP), "]".repeat(DEEP)),
        ),
        ("tables", format!("x = {}", "{a=".repeat(DEEP))),
        ("lists in lines", format!("x = {}", "[\n".repeat(DEEP))),
        ("a dotted key", format!("{}a = 1", "a.".repeat(DEEP))),
        ("a header", format!("[{}a]", "a.".repeat(DEEP))),
        ("a header of a list", format!("[[{}a]]", "a.".repeat(DEEP))),
        (
            "headers within the limit",
            format!("[{}a]\n", "a.".repeat(70)).repeat(wide),
        ),
        (
            "growing headers",
            (1..wide)
                .map(|n| format!("[[{}a]]\n", "a.".repeat(n)))
                .collect(),
        ),
        ("open strings", format!("x = {}", "\"\"\"\n".repeat(DEEP))),
    ] {
        let found = problems(&format!("{head}{nest}\n"));
        assert!(
            !found.is_empty() && found.len() <= LISTED + 1,
            "{what}: {}",
            found.len()
        );
    }
}

#[test]
fn a_line_of_a_hundred_megabytes_is_refused_by_name() {
    const LINE: usize = 100_000_000;
    let head = "[scene]\nname = \"long\"\nspace = \"plane\"\n";
    for (begin, part, end) in [
        ("x = \"", "a", "\""),
        ("# ", "comment ", ""),
        ("x = [", "0,", "]"),
        ("x = [", "[],", "]"),
        ("", "a.", "a = 1"),
        ("x = ", "[", ""),
        ("", "\u{0}", ""),
    ] {
        let line = format!("{begin}{}{end}", part.repeat(LINE / part.len()));
        let found = problems(&format!("{head}{line}\n"));
        assert_eq!(found.len(), 1);
        let message = found[0].to_string();
        assert!(
            message.starts_with("x.toml:4:")
                && message.ends_with("bytes, more than 4194304: write long lists in several lines"),
            "{message}"
        );
    }
}

#[test]
fn a_long_line_of_nothing_but_faults_is_one_fault() {
    let found = problems(&format!("x = {}\n", "\u{1}".repeat(4_000_000)));
    assert_eq!(found.len(), 1);
    assert_eq!(
        (found[0].primary.line, &*found[0].primary.text),
        (1, "not valid TOML")
    );
}

#[test]
fn too_many_values_are_refused_by_name() {
    let head = "[scene]\nname = \"many\"\nspace = \"plane\"\nx = [\n";
    let found = problems(&format!("{head}{}]\n", "0,\n".repeat(1 << 23)));
    assert_eq!(found.len(), 1);
    assert!(
        found[0]
            .message
            .starts_with("more than 8388608 signs `[`, `{`, `,` and `=`"),
        "{}",
        found[0]
    );
}

#[test]
fn a_long_line_within_the_limit_is_read() {
    let rows = 100_000;
    let list = |f: fn(usize) -> f64| {
        let values: Vec<String> = (0..rows).map(|k| format!("{:?}", f(k))).collect();
        values.join(", ")
    };
    let text = format!(
        "[scene]\nname = \"table\"\nspace = \"plane\"\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\n\
         [[force]]\nname = \"f\"\ntype = \"torque\"\nbody = \"b\"\n\
         torque = {{ type = \"table\", times = [{}], values = [{}] }}\n",
        list(|k| k as f64 / 1000.0),
        list(|k| (k as f64 / 1000.0).sin())
    );
    let begin = Instant::now();
    let scene = read(&text).unwrap_or_else(|problems| panic!("{}", problems[0]));
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    assert_eq!(scene.description.n_forces(), 1);
    // A line contains only invalid numbers. Positions are computed only for the listed ones.
    let wrong = text.replace("0.", "nan+0.");
    assert!(problems(&wrong).len() <= LISTED + 1);
}

#[test]
fn a_name_of_more_than_a_thousand_letters_is_refused() {
    let text = |letters: usize| {
        format!(
            "[scene]\nname = \"x\"\nspace = \"plane\"\n[[body]]\nname = \"{}\"\nmass = 1.0\ninertia = 1.0\n",
            "ä".repeat(letters)
        )
    };
    assert!(read(&text(1000)).is_ok());
    let found = problems(&text(1001));
    assert_eq!(
        found[0].to_string(),
        "x.toml:5:8: error: body number 1: `name` has 1001 letters, more than 1000"
    );
}
