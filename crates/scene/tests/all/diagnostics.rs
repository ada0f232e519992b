//! Tests messages and positions of diagnostics: one error per case, and one file with many errors.

use pfaff_scene::Diagnostic;

use crate::read;

/// A small scene without errors; in each case, one part of it is replaced.
const SCENE: &str = r#"[scene]
name = "small"
space = "plane"
gravity = [0.0, -9.81]

[[body]]
name = "frame"
mass = 1.0
inertia = 0.1

[[body]]
name = "crank"
mass = 2.0
inertia = 0.2
position = [1.0, 2.0]

[[joint]]
name = "A"
type = "revolute"
bodies = ["frame", "crank"]
at = [1.0, 0.0]

[[joint]]
name = "W"
type = "knife-edge"
body = "crank"
at = [1.0, 2.0]
normal = [0.0, 1.0]

[[drive]]
name = "motor"
joint = "A"
type = "angle"
motion = { type = "constant-rate", rate = 2.0 }

[[force]]
name = "spring"
type = "spring-damper"
bodies = ["ground", "crank"]
at = [[0.0, 0.0], [1.0, 2.0]]
stiffness = 10.0
damping = 0.5

[simulate]
t_end = 2.0
drop = [1]
"#;

/// A case: a part of the scene, its replacement with «» around the position that must be marked,
/// the message, and the text of the mark.
pub(crate) type Case = (&'static str, &'static str, &'static str, &'static str);

fn check(cases: &[Case]) {
    check_in(SCENE, cases);
}

/// Checks that each case causes exactly this problem, in a scene without other errors.
pub(crate) fn check_in(scene: &str, cases: &[Case]) {
    assert!(read(scene).is_ok(), "{:#?}", read(scene));
    for &(part, fault, message, label) in cases {
        assert_eq!(scene.matches(part).count(), 1, "{part}");
        let marked = scene.replace(part, fault);
        let start = marked.find('«').expect("a mark");
        let text = marked.replace(['«', '»'], "");
        let end = marked.replace('«', "").find('»').expect("a mark");
        let problems = read(&text).expect_err(fault);
        let [d] = &problems[..] else {
            panic!("{fault}: {problems:#?}");
        };
        let before = &marked[..start];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        assert_eq!(
            d.to_string(),
            format!("x.toml:{line}:{column}: error: {message}")
        );
        assert_eq!(
            (&d.primary.text[..], &d.primary.span),
            (label, &(start..end)),
            "{fault}"
        );
    }
}

#[test]
fn tables_and_keys() {
    check(&[
        (
            "mass = 1.0",
            "«mas» = 1.0\nmass = 1.0",
            "body `frame` has no key `mas`",
            "did you mean `mass`?",
        ),
        (
            "[[body]]\nname = \"frame\"\nmass = 1.0",
            "«[[body]]»\nname = \"frame\"",
            "body `frame` needs the key `mass`: a number ≥ 0",
            "`mass` is missing here",
        ),
        (
            "[simulate]",
            "[«simulation»]\nt_end = 2.0\n[simulate]",
            "the scene has no key `simulation`",
            "did you mean `simulate`?",
        ),
        (
            "[simulate]",
            "«[[simulate]]»",
            "the scene: `simulate` must be one table `[simulate]`, found a list of 1 value",
            "expected one table `[simulate]`",
        ),
        (
            "[[force]]",
            "«[force]»",
            "the scene: `force` must be a list of tables `[[force]]`, found a table",
            "expected a list of tables `[[force]]`",
        ),
        (
            "mass = 1.0",
            "mass = 1.0\n«mass» = 2.0",
            "`mass` is given twice",
            "given again here",
        ),
    ]);
}

#[test]
fn values() {
    check(&[
        (
            "mass = 1.0",
            "mass = «\"heavy\"»",
            "body `frame`: `mass` must be a number, found the text \"heavy\"",
            "expected a number",
        ),
        (
            "mass = 1.0",
            "mass = «0x»",
            "body `frame`: `mass` must be a number, found a number that cannot be read",
            "expected a number",
        ),
        (
            "mass = 1.0",
            "mass = «nan»",
            "body `frame`: `mass` is NaN, need a finite number up to 1e60",
            "not a usable number",
        ),
        (
            "mass = 1.0",
            "mass = «1e999»",
            "body `frame`: `mass` is inf, need a finite number up to 1e60",
            "not a usable number",
        ),
        (
            "mass = 1.0",
            "mass = «-1»",
            "body `frame`: mass is -1, need a number ≥ 0",
            "may not be negative",
        ),
        (
            "position = [1.0, 2.0]",
            "position = [1.0, «-1.1e60»]",
            "body `crank`: `position` is -1.1e60, need a finite number up to 1e60",
            "not a usable number",
        ),
        (
            "position = [1.0, 2.0]",
            "position = [1.0, «-inf»]",
            "body `crank`: `position` is -inf, need a finite number up to 1e60",
            "not a usable number",
        ),
        (
            "position = [1.0, 2.0]",
            "position = «[1.0]»",
            "body `crank`: `position` must be a pair [x, y], found a list of 1 value",
            "expected a pair [x, y]",
        ),
        (
            "[0.0, -9.81]",
            "«9.81»",
            "`[scene]`: `gravity` must be an acceleration [gx, gy], found the number 9.81",
            "expected an acceleration [gx, gy]",
        ),
        (
            "\"plane\"",
            "«\"room\"»",
            "`[scene]`: `space` is \"room\", there are `plane`, `spatial`",
            "no such space",
        ),
    ]);
}

#[test]
fn names() {
    check(&[
        (
            "[[force]]\nname = \"spring\"",
            "[[force]]\nname = «\" \"»",
            "force number 1: `name` is empty",
            "expected a name",
        ),
        (
            "[[force]]\nname = \"spring\"",
            "[[force]]\nname = «\"two\\nlines\"»",
            "force number 1: `name` has the control character '\\n': names are of one line",
            "choose another name",
        ),
        (
            "[[force]]\nname = \"spring\"",
            "[[force]]\nname = «\"=1+2\"»",
            "force number 1: `name` begins with `=`: spreadsheets take such names for formulas",
            "choose another name",
        ),
        (
            "\"spring\"",
            "«\"W\"»",
            "the name `W` is used twice",
            "used again here",
        ),
        (
            "[[drive]]",
            "[[body]]\nname = «\"frame\"»\nmass = 0\ninertia = 0\n[[drive]]",
            "the name `frame` is used twice",
            "used again here",
        ),
        (
            "\"spring\"",
            "«\"ground\"»",
            "`ground` is the reserved name of the ground",
            "choose another name",
        ),
        (
            "bodies = [\"frame\", \"crank\"]",
            "bodies = [«\"fraem\"», \"crank\"]",
            "joint `A` refers to the unknown body `fraem`",
            "no such body; `frame` is defined on line 7",
        ),
        (
            "joint = \"A\"",
            "joint = «\"B\"»",
            "drive `motor` refers to the unknown joint `B`",
            "no such joint",
        ),
        (
            "joint = \"A\"",
            "joint = «\"elbow\"»",
            "drive `motor` refers to the unknown joint `elbow`",
            "no such joint",
        ),
    ]);
}

#[test]
fn types_and_bodies() {
    check(&[
        (
            "\"revolute\"\nbodies = [\"frame\", \"crank\"]\nat = [1.0, 0.0]\n",
            "«\"revolut\"»\n",
            "joint `A` has the unknown type `revolut`",
            "did you mean `revolute`?",
        ),
        (
            "\"knife-edge\"",
            "«\"bushing\"»",
            "joint `W` has the unknown type `bushing`",
            "`bushing` is a force",
        ),
        (
            "bodies = [\"frame\", \"crank\"]",
            "bodies = «[\"frame\", \"crank\", \"ground\"]»",
            "joint `A`: `bodies` must be two bodies [first, second], found a list of 3 values",
            "expected two bodies [first, second]",
        ),
        (
            "bodies = [\"frame\", \"crank\"]",
            "body = «\"frame\"»",
            "joint `A` takes `bodies = [first, second]`, not `body`",
            "expected `bodies = [first, second]`",
        ),
        (
            "body = \"crank\"",
            "bodies = «[\"crank\", \"frame\"]»",
            "joint `W` takes `body = …`, not `bodies`",
            "expected `body = …`",
        ),
        (
            "[[joint]]\nname = \"W\"\ntype = \"knife-edge\"\nbody = \"crank\"",
            "«[[joint]]»\nname = \"W\"\ntype = \"knife-edge\"",
            "joint `W` needs `body = …`",
            "the bodies are missing here",
        ),
        (
            "bodies = [\"ground\", \"crank\"]",
            "bodies = «[\"crank\", \"crank\"]»",
            "`spring` connects `crank` with itself",
            "give two different bodies",
        ),
        (
            "bodies = [\"frame\", \"crank\"]",
            "bodies = «[\"ground\", \"ground\"]»",
            "`A` connects the ground with itself",
            "at least one body must be able to move",
        ),
        (
            "type = \"spring-damper\"\nbodies = [\"ground\", \"crank\"]\nat = [[0.0, 0.0], [1.0, 2.0]]\nstiffness = 10.0\ndamping = 0.5",
            "type = \"point-force\"\nbody = \"crank\"\nat = [0, 0]\nforce = [0, 0]\nframe = «\"local\"»",
            "force `spring`: `frame` must be one of `body`, `global`, found `local`",
            "no such choice",
        ),
        (
            "type = \"spring-damper\"\nbodies = [\"ground\", \"crank\"]\nat = [[0.0, 0.0], [1.0, 2.0]]\nstiffness = 10.0\ndamping = 0.5",
            "type = \"torque\"\nbody = \"crank\"\nbodies = «[\"frame\", \"crank\"]»\ntorque = 1",
            "force `spring` takes `body = …` or `bodies = [first, second]`, not both",
            "and here two bodies are given",
        ),
    ]);
}

/// A drive of a length replaces its joint, and has its problems.
#[test]
fn joints_that_drives_replace() {
    const MOTOR: &str = "[[drive]]\nname = \"motor\"\njoint = \"A\"\ntype = \"angle\"\nmotion = { type = \"constant-rate\", rate = 2.0 }";
    check(&[
        (
            MOTOR,
            "[[joint]]\nname = \"rod\"\ntype = \"distance\"\nbodies = [\"crank\", \"crank\"]\nat = [[0, 0], [1, 0]]\n\n[[drive]]\nname = \"motor\"\njoint = «\"rod\"»\ntype = \"length\"\nmotion = 0",
            "`motor` connects `crank` with itself",
            "give two different bodies",
        ),
        (
            MOTOR,
            "[[joint]]\nname = \"rod\"\ntype = \"distance\"\nbodies = [\"frame\", \"crank\"]\nat = [[0, 0], [1, 0]]\ntolerance = -1\n\n[[drive]]\nname = \"motor\"\njoint = «\"rod\"»\ntype = \"length\"\nmotion = 0",
            "drive `motor`: tolerance is -1.0, need a finite number > 0 up to 1e60",
            "expected a number > 0",
        ),
    ]);
}

#[test]
fn places_and_parameters() {
    check(&[
        (
            "[[joint]]\nname = \"W\"\ntype = \"knife-edge\"\nbody = \"crank\"\nat = [1.0, 2.0]",
            "«[[joint]]»\nname = \"W\"\ntype = \"knife-edge\"\nbody = \"crank\"",
            "joint `W` needs a place: `at = [x, y]` in global coordinates, or `point` in the frame of the body",
            "the place is missing here",
        ),
        (
            "at = [1.0, 0.0]",
            "at = [1.0, 0.0]\npoints = «{ frame = [0, 0], crank = [0, 0] }»",
            "joint `A` takes `at` or `points`, not both",
            "and here in the frames of the bodies",
        ),
        (
            "at = [1.0, 0.0]",
            "points = { frame = [0, 0], crank = [0, 0], «W» = [0, 0] }",
            "joint `A`: `points` names `W`, which has no point here",
            "not a body with a point here",
        ),
        (
            "at = [1.0, 0.0]",
            "points = «{ frame = [0, 0] }»",
            "joint `A`: `points` needs the point of `crank`",
            "`crank = [x, y]` is missing here",
        ),
        (
            "at = [[0.0, 0.0], [1.0, 2.0]]",
            "at = «[0.0, 1.0]»",
            "force `spring`: `at` must be 2 global points [[x, y], …], found a list of 2 values",
            "expected 2 global points [[x, y], …]",
        ),
        (
            "normal = [0.0, 1.0]",
            "normal = «[0.0, 0.0]»",
            "joint `W`: `normal` has no direction: the vector is (0, 0), of length zero",
            "has no direction",
        ),
        (
            "type = \"knife-edge\"\nbody = \"crank\"\nat = [1.0, 2.0]\nnormal = [0.0, 1.0]",
            "type = \"point-on-line\"\nbody = \"crank\"\nat = [1.0, 2.0]\nline = «[[1, 1], [1, 1]]»",
            "joint `W`: `line` has no direction: the vector is (0, 0), of length zero",
            "has no direction",
        ),
        (
            "stiffness = 10.0",
            "stiffness = «-10.0»",
            "force `spring`: `stiffness` is -10, need a number ≥ 0",
            "may not be negative",
        ),
        (
            "stiffness = 10.0",
            "stiffness = «[10.0]»",
            "force `spring`: `stiffness` must be a number ≥ 0 (N/m), found a list of 1 value",
            "expected a number ≥ 0 (N/m)",
        ),
        (
            "[[force]]\nname = \"spring\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"crank\"]\nat = [[0.0, 0.0], [1.0, 2.0]]\nstiffness = 10.0",
            "«[[force]]»\nname = \"spring\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"crank\"]\nat = [[0.0, 0.0], [1.0, 2.0]]",
            "force `spring` needs the key `stiffness`: a number ≥ 0 (N/m)",
            "`stiffness` is missing here",
        ),
        (
            "damping = 0.5",
            "damping = 0.5\n«freelength» = 1.0",
            "force `spring` has no key `freelength`",
            "did you mean `free_length`?",
        ),
    ]);
}

#[test]
fn drives_and_functions() {
    const MOTION: &str = "{ type = \"constant-rate\", rate = 2.0 }";
    check(&[
        (
            "type = \"angle\"",
            "type = «\"angel\"»",
            "drive `motor`: joint `A` (`revolute`) has no measure `angel`",
            "did you mean `angle`?",
        ),
        (
            "joint = \"A\"\ntype = \"angle\"",
            "joint = \"W\"\ntype = «\"angle\"»",
            "drive `motor`: joint `W` (`knife-edge`) has no measure `angle`",
            "no such measure",
        ),
        (
            MOTION,
            "«true»",
            "drive `motor`: `motion` must be a number, an expression of `t` or a function of time { type = … }, found `true`",
            "expected a number, an expression of `t` or a function of time { type = … }",
        ),
        (
            MOTION,
            "{ type = «\"step\"» }",
            "drive `motor`: `motion` has the unknown type `step`",
            "no such function of time",
        ),
        (
            MOTION,
            "«{ type = \"constant-rate\" }»",
            "drive `motor`: `motion` needs the key `rate`: a number",
            "`rate` is missing here",
        ),
        (
            MOTION,
            "{ type = \"harmonic\", amplitude = 1, omega = 1, «fase» = 0 }",
            "drive `motor`: `motion` has no key `fase`",
            "did you mean `phase`?",
        ),
        (
            MOTION,
            "{ type = \"steps\", steps = [{ from = 0, to = 1, by = 1 }, «{ from = 1, to = 1, by = 1 }»] }",
            "drive `motor`: `motion`: `steps`: step 2 runs from t = 1 to t = 1; `to` must be later than `from`",
            "ends before it begins",
        ),
        (
            MOTION,
            "{ type = \"table\", times = [0, 1, «1», 2], values = [0, 0, 0, 0] }",
            "drive `motor`: `motion`: `times`: times must increase: times[2] = 1 follows 1",
            "not later than the time before it",
        ),
        (
            MOTION,
            "{ type = \"table\", times = [0, 1, 2], values = «[0, 0]» }",
            "drive `motor`: `motion`: `values`: 3 times and 2 values; a table needs equal numbers of both",
            "expected as many as `times`",
        ),
        (
            MOTION,
            "{ type = \"table\", times = «[0, 1.5]», values = [0, 0] }",
            "drive `motor`: `motion`: the table runs from t = 0 to t = 1.5, the run from t = 0 to t = 2",
            "must cover the whole run",
        ),
    ]);
}

#[test]
fn runs_starts_and_groups() {
    check(&[
        (
            "t_end = 2.0",
            "t_end = «-2.0»",
            "`[simulate]`: t_end is -2, need a finite time ≥ 0",
            "expected a finite time ≥ 0",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\noutput_step = «0»",
            "`[simulate]`: output_step is 0, need a time > 0",
            "expected a time > 0",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\noutput_step = «1e-7»",
            "`[simulate]`: output_step is 1e-7 s: up to t = 2 s this would write 2e7 rows, more than 1e7",
            "too small for this run",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\nrtol = «0.0»",
            "`[simulate]`: rtol is 0, need a number from 1e-15 (rounding) to 0.1",
            "expected a number from 1e-15 (rounding) to 0.1",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\nmethod = «\"euler\"»",
            "`[simulate]`: `method` `euler` is unknown",
            "no such choice",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\n«formulation» = \"null-space\"",
            "`[simulate]` has no key `formulation`",
            "unknown key",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\nstabilisation = «\"baumgarte\"»",
            "`[simulate]`: `stabilisation` `baumgarte` is unknown",
            "no such choice",
        ),
        (
            "drop = [1]",
            "drop = [1, «0»]",
            "`[simulate]`: `drop` names row 0; rows are counted from 1",
            "no such row",
        ),
        (
            "drop = [1]",
            "drop = [2, 1, «2»]",
            "`[simulate]`: `drop` names row 2 twice",
            "named again here",
        ),
        (
            "drop = [1]",
            "drop = [«5»]",
            "`[simulate]`: `drop` names row 5; rows are 1 to 4",
            "no such row",
        ),
        (
            "drop = [1]",
            "drop = [«1.0»]",
            "`[simulate]`: `drop` must be a list of rows, counted from 1, found the number 1",
            "expected a list of rows, counted from 1",
        ),
        (
            "[simulate]",
            "[start]\nkeep = [«\"crnk.angle\"»]\n[simulate]",
            "`[start]` refers to the unknown body `crnk`",
            "no such body; `crank` is defined on line 12",
        ),
        (
            "[simulate]",
            "[start]\nkeep = [\"crank.x\", «\"crank.vz\"»]\n[simulate]",
            "`[start]`: `keep` names the unknown coordinate `vz`",
            "no such coordinate",
        ),
        (
            "[simulate]",
            "[start]\nkeep = [«\"ground.x\"»]\n[simulate]",
            "`[start]`: `keep` names the ground, which has no coordinates",
            "the ground does not move",
        ),
        (
            "[simulate]",
            "[start]\nallow_correction = «\"yes\"»\n[simulate]",
            "`[start]`: `allow_correction` must be true or false, found the text \"yes\"",
            "expected true or false",
        ),
        (
            "[simulate]",
            "[[group]]\nname = \"g\"\nmembers = [\"A\", «\"spring\"»]\n[simulate]",
            "group `g` refers to the unknown joint or drive `spring`",
            "no such joint or drive",
        ),
        (
            "[simulate]",
            "[[group]]\nname = \"g\"\nmembers = «[]»\n[simulate]",
            "group `g`: `members` is empty",
            "needs at least one joint or drive",
        ),
        (
            "[simulate]",
            "[[group]]\nname = \"g\"\ncombine = \"W.N + «W»\"\n[simulate]",
            "group `g`: `combine`: `W` is a whole reaction, but the first term is a component; write all terms with a component, or none",
            "here",
        ),
        (
            "[simulate]",
            "[[group]]\nname = \"g\"\ncombine = \"W.N - 2*«W.Fz»\"\n[simulate]",
            "group `g`: `combine`: the reaction of `W` has no component `Fz`; it has `Fx`, `Fy`, `T`, `N`",
            "here",
        ),
        (
            "[simulate]",
            "«[[group]]»\nname = \"g\"\n[simulate]",
            "group `g` needs `members = [\"A\", …]` or `combine = \"A.Fx + …\"`",
            "its content is missing here",
        ),
        (
            "[simulate]",
            "[output]\nreactions = [\"A\", «\"A\"»]\n[simulate]",
            "`[output]`: `reactions` names `A` twice",
            "named again here",
        ),
    ]);
}

fn lines(problems: &[Diagnostic]) -> Vec<String> {
    problems.iter().map(ToString::to_string).collect()
}

#[test]
fn collisions_mark_the_first_use_as_well() {
    let text = SCENE.replace("\"spring\"", "\"W\"");
    let problems = read(&text).expect_err("a name twice");
    let first = &problems[0].secondary[0];
    assert_eq!((first.line, first.column), (24, 8));
    assert_eq!(first.text, "first used here");
}

#[test]
fn help_lists_what_there_is() {
    for (part, fault, help) in [
        (
            "joint = \"A\"\ntype = \"angle\"",
            "joint = \"A\"\ntype = \"displacement\"",
            "its measures are `angle`",
        ),
        (
            "joint = \"A\"",
            "joint = \"W\"",
            "joints of this type cannot be driven",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\nmethod = \"euler\"",
            "available are `auto`, `dop853`, `dopri5`, `tsit5`, `radau5`",
        ),
        (
            "t_end = 2.0",
            "t_end = 2.0\nmethod = \"dorpi5\"",
            "did you mean `dopri5`?",
        ),
        ("\"knife-edge\"", "\"torque\"", "write it under `[[force]]`"),
        (
            "at = [1.0, 0.0]",
            "at = [1.0, 0.0]\naxle = [1, 0]",
            "its keys are `name`, `type`, `bodies`, `at`, `points`, `tolerance`, `centre_of_stiffness`, `armature`, `active`",
        ),
    ] {
        let problems = read(&SCENE.replace(part, fault)).expect_err(fault);
        assert_eq!(problems[0].help.as_deref(), Some(help), "{problems:#?}");
    }
}

/// One file contains errors of all kinds. All of them are reported, each once, without problems
/// that are only consequences. `name` is misspelt and therefore not reported as missing, and
/// `chasis` may be the name of the third body.
#[test]
fn a_file_with_many_faults_reports_all_of_them() {
    let text = r#"
[scene]
nme = "wreck"
space = "plane"

[[body]]
name = "a"
mass = -1.0
inertia = nan

[[body]]
name = "a"
mass = 1.0
inertia = 1.0
colour = "red"

[[body]]
mass = 1.0
inertia = 1.0

[[joint]]
name = "J"
type = "revolute"
bodies = ["a", "chasis"]
at = [0.0, "left"]
axis = [1.0, 0.0]

[[joint]]
name = "K"
type = "hinge"
bodies = ["a", "ground"]

[[drive]]
name = "J"
joint = "K"
type = "angle"
motion = { type = "steps", steps = [{ from = 2, to = 1, by = 1 }, { from = 3, to = 3, by = 1 }] }

[[force]]
name = "F"
type = "spring-damper"
bodies = ["a", "a"]
at = [[0.0, 0.0], [1.0, 0.0]]
stiffness = -1.0
damping = -2.0

[simulate]
method = "euler"
drop = [0]

[[group]]
name = "G"
members = ["J", "K", "L"]
"#;
    let problems = read(text).expect_err("a wreck");
    assert_eq!(
        lines(&problems),
        [
            "x.toml:3:1: error: `[scene]` has no key `nme`",
            "x.toml:8:8: error: body `a`: mass is -1, need a number ≥ 0",
            "x.toml:9:11: error: body `a`: `inertia` is NaN, need a finite number up to 1e60",
            "x.toml:12:8: error: the name `a` is used twice",
            "x.toml:15:1: error: body `a` has no key `colour`",
            "x.toml:17:1: error: body number 3 needs the key `name`: a text",
            "x.toml:25:12: error: joint `J`: `at` must be a number, found the text \"left\"",
            "x.toml:26:1: error: joint `J` has no key `axis`",
            "x.toml:30:8: error: joint `K` has the unknown type `hinge`",
            "x.toml:34:8: error: the name `J` is used twice",
            "x.toml:37:37: error: drive `J`: `motion`: `steps`: step 1 runs from t = 2 to t = 1; `to` must be later than `from`",
            "x.toml:37:67: error: drive `J`: `motion`: `steps`: step 2 runs from t = 3 to t = 3; `to` must be later than `from`",
            "x.toml:44:13: error: force `F`: `stiffness` is -1, need a number ≥ 0",
            "x.toml:45:11: error: force `F`: `damping` is -2, need a number ≥ 0",
            "x.toml:47:1: error: `[simulate]` needs the key `t_end`: the last time in s",
            "x.toml:48:10: error: `[simulate]`: `method` `euler` is unknown",
            "x.toml:49:9: error: `[simulate]`: `drop` names row 0; rows are counted from 1",
            "x.toml:53:22: error: group `G` refers to the unknown joint or drive `L`",
        ]
    );
}

#[test]
fn a_text_that_is_not_toml_is_judged_line_by_line() {
    let text = SCENE
        .replace("mass = 1.0", "mass = heavy")
        .replace("damping = 0.5", "damping = 0.5 N");
    assert_eq!(
        lines(&read(&text).expect_err("no TOML")),
        [
            "x.toml:8:8: error: a text without quotes",
            "x.toml:42:11: error: a number with a unit",
        ]
    );
}

/// In the format with expressions, the advice for a unit is only to add quotes.
#[test]
fn a_unit_without_quotes_gets_them() {
    let help = |format: &str| {
        let text = format!(
            "[scene]\nname = \"a\"\nspace = \"plane\"\n{format}\n[simulate]\nt_end = 2 min # long\n"
        );
        let problems = read(&text).expect_err("no TOML");
        assert_eq!(problems.len(), 1, "{problems:#?}");
        problems[0].help.clone().unwrap_or_default()
    };
    assert_eq!(
        help("format = 2"),
        "values with units need quotes: write `\"2 min\"`"
    );
    assert!(help("").ends_with("write `120` instead of `2 min`"));
}

/// After a bracket that is never closed, the rest of the text is not reported as separate errors.
#[test]
fn a_bracket_that_is_never_closed_hides_its_consequences() {
    let text = SCENE.replace("\"crank\"]\nat = [1.0, 0.0]", "\"crank\"\nat = [1.0, 0.0]");
    assert_eq!(
        lines(&read(&text).expect_err("no TOML")),
        ["x.toml:20:10: error: a bracket is never closed"]
    );
}

/// Each body without a name explains references to only one missing body.
#[test]
fn names_of_unnamed_bodies_are_not_reported_again() {
    let unknown = |text: &str| -> Vec<String> {
        let said = lines(&read(text).expect_err("wrong"));
        said.into_iter()
            .filter(|line| line.contains("unknown body"))
            .collect()
    };
    let twice = SCENE.replace("name = \"crank\"", "name = \"frame\"");
    assert_eq!(unknown(&twice), [""; 0]);
    let and_another = twice.replace("body = \"crank\"", "body = \"wheel\"");
    assert_eq!(unknown(&and_another).len(), 1, "{and_another}");
    let plural = SCENE.replace("[[body]]", "[[bodies]]");
    assert_eq!(lines(&read(&plural).expect_err("plural")).len(), 1);
}

/// Rows are counted if all joints and drives can be read, even if there are other errors.
#[test]
fn dropped_rows_are_checked_beside_other_faults() {
    let text = SCENE
        .replace("mass = 1.0", "mass = -1.0")
        .replace("drop = [1]", "drop = [5]");
    assert_eq!(
        lines(&read(&text).expect_err("two faults")),
        [
            "x.toml:8:8: error: body `frame`: mass is -1, need a number ≥ 0",
            "x.toml:46:9: error: `[simulate]`: `drop` names row 5; rows are 1 to 4",
        ]
    );
}

/// The numbers are in the permitted range, but their difference overflows.
#[test]
fn places_too_far_away_are_refused() {
    let text = SCENE
        .replace("position = [1.0, 2.0]", "position = [1e60, 2.0]")
        .replace("at = [1.0, 2.0]", "at = [-1e60, 2.0]");
    assert_eq!(
        lines(&read(&text).expect_err("infinitely far")),
        [
            "x.toml:27:6: error: joint `W`: `at` and the position of `crank` are too far apart: \
             their difference is not a finite number up to 1e60"
        ]
    );
}

/// Thousands of problems are reported within a short time, including joints that refer to missing
/// bodies.
#[test]
fn thousands_of_problems_are_reported() {
    let body = |k| format!("[[body]]\nname = \"b{k}\"\nmass = 1\ninertia = 1\n");
    let joint = |k| {
        format!("[[joint]]\nname = \"j{k}\"\ntype = \"angle\"\nbodies = [\"ground\", \"c{k}\"]\n")
    };
    let head = "[scene]\nname = \"large\"\nspace = \"plane\"\n".to_owned();
    let text = (0..5000).fold(head, |text, k| text + &body(k) + &joint(k));
    let problems = read(&text).expect_err("no body has that name");
    assert_eq!(problems.len(), 5000);
    assert_eq!(
        problems[17].primary.text,
        "no such body; `b17` is defined on line 141"
    );
    assert_eq!(problems[4999].primary.text, "no such body");
}

/// An empty text contains no scene.
#[test]
fn an_empty_file_says_what_a_scene_needs() {
    let problems = read("").expect_err("nothing");
    assert_eq!(
        lines(&problems),
        [
            "x.toml:1:1: error: the scene needs the section `[scene]`",
            "x.toml:1:1: error: a mechanism needs at least one body",
        ]
    );
}

#[test]
fn the_longest_table_is_allowed_and_a_longer_one_gets_advice() {
    let with_step = |step: &str| {
        read(&SCENE.replace("t_end = 2.0", &format!("t_end = 2.0\noutput_step = {step}")))
    };
    assert!(with_step("2e-7").is_ok());
    for step in ["1.99e-7", "1e-300", "5e-324"] {
        let problems = with_step(step).expect_err(step);
        let [d] = &problems[..] else {
            panic!("{step}: {problems:#?}");
        };
        assert_eq!(d.secondary[0].text, "the run ends here");
        assert_eq!(
            d.help.as_deref(),
            Some("`output_step = 2e-4` gives 1e4 rows; without the key there are 201")
        );
    }
    assert!(with_step("2e-4").is_ok());
}

/// A line of 4 MiB and 2²³ signs are permitted, and one more of each is an error at its position.
#[test]
fn large_texts_are_refused_at_once() {
    let said = |text: &str| {
        let problems = read(text).expect_err("not a scene");
        (
            problems[0].code.to_string(),
            problems[0].primary.span.clone(),
        )
    };
    let line = |bytes: usize| format!("#{}\n", "x".repeat(bytes - 1));
    assert_ne!(said(&line(4 << 20)).0, "P0113");
    let longer = said(&line((4 << 20) + 1));
    assert_eq!(longer, ("P0113".to_owned(), (4 << 20)..(4 << 20) + 1));
    let signs = |n: usize| "#[[[[[[[[[[[[[[[\n".repeat(n / 15) + "#" + &"[".repeat(n % 15);
    assert_ne!(said(&signs(1 << 23)).0, "P0113");
    let (code, span) = said(&signs((1 << 23) + 1));
    assert_eq!((code.as_str(), span.len()), ("P0113", 1));
}
