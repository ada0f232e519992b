//! The table of codes: below 100 the command and its files, from 100 the text of a scene, from 200
//! its start and its rank, from 300 questions, from 400 runs, from 500 sweeps, from 600
//! files that are imported.

use super::{Code, Entry, Example};

const fn entry(code: u16, title: &'static str, advice: &'static str, example: Example) -> Entry {
    Entry {
        code: Code(code),
        title,
        advice,
        example,
    }
}

const RARE: Example = Example::None("the machine or the numbers have to be special");
const MACHINE: Example = Example::None("it depends on the machine");
const LIBRARY: Example =
    Example::None("only programs meet it: the reader of scenes refuses it before");
const CALLED: Example = Example::None("only programs have functions that are called");

macro_rules! scene {
    ($text:literal) => {
        concat!("[scene]\nname = \"bar\"\nspace = \"plane\"\n", $text)
    };
}

macro_rules! computed {
    ($text:literal) => {
        concat!(
            "[scene]\nformat = 2\nname = \"bar\"\nspace = \"plane\"\n",
            $text
        )
    };
}

macro_rules! bar {
    ($text:literal) => {
        concat!(
            "[scene]\nname = \"bar\"\nspace = \"plane\"\n\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\n",
            $text
        )
    };
}

macro_rules! block {
    ($text:literal) => {
        concat!(
            "[scene]\nname = \"block\"\nspace = \"spatial\"\n\n[[body]]\nname = \"block\"\nmass = 1.0\n",
            $text
        )
    };
}

/// All codes, ascending.
pub const TABLE: &[Entry] = &[
    entry(
        1,
        "The command line is wrong",
        "The message names the option; `pfaff COMMAND --help` lists all.",
        Example::Command("analyze scene.toml --no-such-option"),
    ),
    entry(
        2,
        "A file cannot be read",
        "Correct its name or its rights; a scene is a text in UTF-8 of at most 256 MiB.",
        Example::Command("check no-such-file.toml"),
    ),
    entry(
        3,
        "Results cannot be written there",
        "Choose a directory, or for `view` a file, in which files can be made.",
        Example::Command("new door --out no-such-directory/door.toml"),
    ),
    entry(
        4,
        "A file that pfaff has not written would be replaced",
        "Choose another place, or replace it with `--force`.",
        Example::None("it needs such a file"),
    ),
    entry(
        5,
        "Another run is writing into the directory",
        "Wait for its end, or choose another directory.",
        Example::None("it needs another run"),
    ),
    entry(
        6,
        "Writing failed",
        "Make room on the disk. What has been written ends with a whole line.",
        MACHINE,
    ),
    entry(
        7,
        "The computation needs more memory than there is",
        "Take a smaller scene or a larger machine; `--max-memory` overrides the limit.",
        Example::Command("check - --max-memory 1B"),
    ),
    entry(
        8,
        "The command was interrupted",
        "What it had computed is kept; `summary.json` says `partial`.",
        Example::None("it needs somebody who presses Ctrl-C"),
    ),
    entry(9, "The computation stopped", "The message says why.", RARE),
    entry(
        101,
        "The text is not TOML",
        "Correct the marked line; texts stand in quotes, tables in brackets.",
        Example::Scene("check -", "[scene\nname = \"bar\"\n"),
    ),
    entry(
        102,
        "A table has no such key",
        "Use one of the keys that the message lists, or delete the line.",
        Example::Scene("check -", bar!("colour = \"red\"\n")),
    ),
    entry(
        103,
        "A table lacks a key, or a scene a table",
        "Add it; the book and `pfaff schema` list what is required.",
        Example::Scene("check -", "[[body]]\nmass = 1.0\ninertia = 0.1\n"),
    ),
    entry(
        104,
        "A name or an entry is given twice",
        "Rename or delete one of the two.",
        Example::Scene(
            "check -",
            bar!("\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\n"),
        ),
    ),
    entry(
        105,
        "A value is of another kind than its key requires",
        "Write a value of the kind that the message names.",
        Example::Scene(
            "check -",
            scene!("\n[[body]]\nname = \"bar\"\nmass = true\ninertia = 0.1\n"),
        ),
    ),
    entry(
        106,
        "A text is not an expression",
        "Correct the marked part: an operator, a bracket, or the values of a function.",
        Example::Scene(
            "check -",
            computed!("\n[[body]]\nname = \"bar\"\nmass = \"2*\"\ninertia = 0.1\n"),
        ),
    ),
    entry(
        107,
        "There are more problems than are listed",
        "Correct those that are listed first.",
        Example::None("it needs thousands of problems"),
    ),
    entry(
        108,
        "A name cannot be used",
        "Choose a name in one line that is not empty and does not begin like a formula of a spreadsheet; parameters have letters, digits and `_`.",
        Example::Scene(
            "check -",
            scene!("\n[[body]]\nname = \"=bar\"\nmass = 1.0\ninertia = 0.1\n"),
        ),
    ),
    entry(
        109,
        "A name already means something else",
        "Choose another name: this one is a column of a table, or a function, a unit or a measure in expressions.",
        Example::Scene("check -", computed!("\n[parameters]\nsin = 1.0\n")),
    ),
    entry(
        110,
        "A number is outside of its range",
        "Write a number within the range that the message states.",
        Example::Scene("check -", bar!("\n[simulate]\nt_end = 1.0\nrtol = 2.0\n")),
    ),
    entry(
        111,
        "A number is not finite, or above 1e60",
        "Write a finite number in a unit that keeps it below 1e60; places that are far apart need such a difference, too.",
        Example::Scene(
            "check -",
            scene!("\n[[body]]\nname = \"bar\"\nmass = inf\ninertia = 0.1\n"),
        ),
    ),
    entry(
        112,
        "A direction has no length",
        "Write a direction that is not zero, or a line through two different points.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"translational\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\naxis = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        113,
        "The text is too large for a scene",
        "Write long lists in several lines, or split the mechanism; the message states the limit.",
        Example::None("it needs a text of several megabytes"),
    ),
    entry(
        114,
        "A key has no such choice",
        "Write one of the words that the message lists.",
        Example::Scene("check -", "[scene]\nname = \"bar\"\nspace = \"moon\"\n"),
    ),
    entry(
        115,
        "Keys of a table exclude each other",
        "Keep one of them.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\npoints = { ground = [0.0, 0.0], bar = [0.0, 0.0] }\n"
            ),
        ),
    ),
    entry(
        116,
        "A type is unknown",
        "Write one of the types that the message lists; joints, forces and drives have tables of their own.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolut\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        117,
        "Times of a function do not increase",
        "Write later times after earlier ones; a step ends after it begins.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = { type = \"table\", times = [0.0, 2.0, 1.0], values = [0.0, 1.0, 2.0] }\n"
            ),
        ),
    ),
    entry(
        118,
        "A table of a function has the wrong number of values",
        "Write at least two times, and as many values.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = { type = \"table\", times = [0.0, 1.0], values = [0.0, 1.0, 2.0] }\n"
            ),
        ),
    ),
    entry(
        119,
        "A table of a function does not cover the run",
        "Write values for the whole run, or end the run before.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = { type = \"table\", times = [0.0, 1.0], values = [0.0, 1.0] }\n\n[simulate]\nt_end = 2.0\n"
            ),
        ),
    ),
    entry(
        120,
        "A mechanism has no bodies",
        "Add a `[[body]]`.",
        LIBRARY,
    ),
    entry(
        121,
        "A body is called `ground`",
        "Choose another name: the ground is always there.",
        LIBRARY,
    ),
    entry(
        122,
        "A number of a body or an element is not finite, or above 1e60",
        "Write a finite number; up to 1e60 their products can be computed.",
        LIBRARY,
    ),
    entry(
        123,
        "A mass or an inertia is negative",
        "Write a number ≥ 0.",
        Example::Scene(
            "check -",
            scene!("\n[[body]]\nname = \"bar\"\nmass = -1.0\ninertia = 0.1\n"),
        ),
    ),
    entry(
        124,
        "Gravity is not finite, or above 1e60",
        "Write two finite numbers up to 1e60.",
        LIBRARY,
    ),
    entry(
        125,
        "A tolerance is not a number above zero",
        "Write a number > 0, or leave it out.",
        LIBRARY,
    ),
    entry(
        126,
        "An element has the wrong number of bodies",
        "Give as many bodies as its type connects, with the key that the message names.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbody = \"bar\"\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        127,
        "A body does not exist",
        "Correct the name, or add the body.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"rod\"]\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        128,
        "An element connects a body with itself",
        "Name two different bodies.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"bar\", \"bar\"]\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        129,
        "An element connects the ground with itself",
        "Name at least one moving body.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"ground\"]\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        130,
        "A place of an element is not possible",
        "Correct the point that the message names.",
        LIBRARY,
    ),
    entry(
        131,
        "A body cannot have this part in an element",
        "Choose another body for it.",
        RARE,
    ),
    entry(
        132,
        "An element has the wrong number of functions of time",
        "Give as many as its type requires.",
        LIBRARY,
    ),
    entry(
        133,
        "A body has a `velocity` without `angular_velocity`, and a `centre`",
        "The velocity is that of the origin of the frame: give the angular velocity with it.",
        Example::Scene(
            "check -",
            bar!("centre = [0.5, 0.0]\nvelocity = [1.0, 0.0]\n"),
        ),
    ),
    entry(
        134,
        "A number of a marker is not finite, or above 1e60",
        "Write finite numbers up to 1e60.",
        LIBRARY,
    ),
    entry(
        135,
        "A marker does not exist",
        "Correct the name, or add the marker.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[marker]]\nname = \"top\"\nbody = \"bar\"\npoint = [1.0, 0.0]\n\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = \"tip\"\n"
            ),
        ),
    ),
    entry(
        136,
        "A measure is between a place and itself",
        "Name two different markers.",
        LIBRARY,
    ),
    entry(
        137,
        "A joint or drive does not exist",
        "Correct the name, or add the joint.",
        Example::Scene(
            "check -",
            bar!("\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = 0.0\n"),
        ),
    ),
    entry(
        138,
        "A joint has no such measure",
        "Write one of the measures that the message lists; some types cannot be driven.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"displacement\"\nmotion = 0.0\n"
            ),
        ),
    ),
    entry(
        139,
        "A load does not act along its measure",
        "Write `force` along a length and `torque` along an angle.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nforce = 1.0\n"
            ),
        ),
    ),
    entry(
        140,
        "An entry refers to something that is not active",
        "Remove `active = false` from it, or write it for this entry, too.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\nactive = false\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = 0.0\n"
            ),
        ),
    ),
    entry(
        141,
        "A marker belongs to another body than the one that is needed",
        "Name a marker of the body; `at` takes the place of any marker.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[marker]]\nname = \"tip\"\nbody = \"bar\"\npoint = [1.0, 0.0]\n\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\npoints = { ground = \"tip\", bar = [1.0, 0.0] }\n"
            ),
        ),
    ),
    entry(
        142,
        "A run would write too many rows",
        "Write a larger `output_step`.",
        Example::Scene(
            "check -",
            bar!("\n[simulate]\nt_end = 1.0\noutput_step = 1e-12\n"),
        ),
    ),
    entry(
        143,
        "An option is not one of a run",
        "Remove it; the message says what is in its place.",
        Example::Scene(
            "check -",
            bar!("\n[simulate]\nt_end = 1.0\nmethod = \"gbs\"\n"),
        ),
    ),
    entry(
        144,
        "An entry needs the format 2",
        "Write `format = 2` in `[scene]`.",
        Example::Scene("check -", bar!("\n[parameters]\nL = 1.0\n")),
    ),
    entry(
        145,
        "Parameters depend on each other",
        "Give one of them a value without the others.",
        Example::Scene(
            "check -",
            computed!("\n[parameters]\na = \"b\"\nb = \"a\"\n"),
        ),
    ),
    entry(
        146,
        "An expression names something unknown",
        "Correct the name, or add it to `[parameters]`.",
        Example::Scene(
            "check -",
            computed!("\n[[body]]\nname = \"bar\"\nmass = \"2*rho\"\ninertia = 0.1\n"),
        ),
    ),
    entry(
        147,
        "Units do not fit",
        "Write the unit that the message asks for; only like quantities have a sum.",
        Example::Scene(
            "check -",
            computed!("\n[[body]]\nname = \"bar\"\nmass = \"2 mm\"\ninertia = 0.1\n"),
        ),
    ),
    entry(
        148,
        "An expression has no finite value up to 1e60",
        "Look for a division by zero, or a function outside of its domain.",
        Example::Scene(
            "check -",
            computed!("\n[[body]]\nname = \"bar\"\nmass = \"1/0\"\ninertia = 0.1\n"),
        ),
    ),
    entry(
        149,
        "Definitions of a type are not registered as the reader needs them",
        "Register each definition of a type once, with its drives; variants need keys that tell them apart.",
        Example::None("only programs with joints of their own meet it"),
    ),
    entry(
        150,
        "A list is empty",
        "Write at least one entry, or leave out the table.",
        Example::Scene("check -", bar!("\n[[group]]\nname = \"G\"\nmembers = []\n")),
    ),
    entry(
        151,
        "A list has the wrong number of values",
        "Write as many values as the message states.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0]\n"
            ),
        ),
    ),
    entry(
        152,
        "An orientation is no rotation",
        "Give a quaternion (w, x, y, z) that is not zero, or a rotation matrix, which turns a right hand into a right hand.",
        Example::Scene(
            "check -",
            block!(
                "inertia = [1, 1, 1]\norientation = { matrix = [[1, 0, 0], [0, 1, 0], [0, 0, -1]] }\n"
            ),
        ),
    ),
    entry(
        153,
        "No body has this tensor of inertia",
        "Give a symmetric tensor about the centre of mass whose largest principal moment is at most the sum of the others.",
        Example::Scene("check -", block!("inertia = [3, 1, 1]\n")),
    ),
    entry(
        154,
        "Joints do not bear two wheels on one carrier",
        "Name two revolute, cylindrical or screw joints, each between one wheel and the same carrier; write the line of action where it does not follow from their axes.",
        Example::Scene(
            "check -",
            block!(
                "inertia = [1, 1, 1]\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"block\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\n[[joint]]\nname = \"teeth\"\ntype = \"mesh\"\nbearings = [\"A\", \"A\"]\nat = [1, 0, 0]\n"
            ),
        ),
    ),
    entry(
        155,
        "A measure does not exist in this space",
        "In the plane there are distance, angle, x, y, speed and angular-velocity; in space there is z, and no angle.",
        LIBRARY,
    ),
    entry(
        180,
        "A warning that is to be silenced does not exist",
        "Write the codes of warnings, P0190 to P0199; errors cannot be silenced.",
        Example::Scene(
            "check -",
            "[scene]\nname = \"bar\"\nspace = \"plane\"\nsilence = [\"P0100\"]\n",
        ),
    ),
    entry(
        190,
        "A number is a small difference of larger ones (warning)",
        "Its digits have cancelled: write it in another way, or state a `tolerance`.",
        RARE,
    ),
    entry(
        191,
        "A drive has a constant motion other than zero (warning)",
        "A drive follows f(t) − f(0), so it holds its measure: write a rate or a function, or 0 to hold it.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"J\"\ntype = \"angle\"\nmotion = 0.3\n"
            ),
        ),
    ),
    entry(
        192,
        "An angle looks like degrees (warning)",
        "Angles without a unit are in radians, unless `units` says otherwise: write `\"45 deg\"` with `format = 2`.",
        Example::Scene("check -", bar!("angle = 45.0\n")),
    ),
    entry(
        193,
        "Gravity is that of no planet (warning)",
        "Write it in m/s², or in the unit of lengths of the scene: it was probably meant in another one.",
        Example::Scene(
            "check -",
            concat!(
                "[scene]\nname = \"bar\"\nspace = \"plane\"\ngravity = [0.0, -9810.0]\n",
                "\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\n"
            ),
        ),
    ),
    entry(
        194,
        "No body of that mass and size has such an inertia (warning)",
        "Write the moment of inertia about the centre of mass, in kg·m² or with the unit of lengths of the scene.",
        Example::Scene(
            "check -",
            scene!(
                "\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 83333.0\n\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [-0.5, 0.0]\n\n[[marker]]\nname = \"tip\"\nbody = \"bar\"\npoint = [0.5, 0.0]\n"
            ),
        ),
    ),
    entry(
        195,
        "No joint holds a body (warning)",
        "Add a joint that names it. A scene without joints has no such warning.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[body]]\nname = \"weight\"\nmass = 1.0\ninertia = 0.1\n\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        196,
        "A joint is far from a body that it connects (warning)",
        "Correct the place of the joint, its unit, or the `position` of the body.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [-0.5, 0.0]\n\n[[joint]]\nname = \"K\"\ntype = \"knife-edge\"\nbody = \"bar\"\nat = [500.0, 0.0]\nnormal = [0.0, 1.0]\n"
            ),
        ),
    ),
    entry(
        197,
        "Rows of output are farther apart than the run is long (warning)",
        "Write a shorter `output_step`, or leave it out for 200 steps.",
        Example::Scene(
            "check -",
            bar!("\n[simulate]\nt_end = 1.0\noutput_step = 10.0\n"),
        ),
    ),
    entry(
        198,
        "A measure is between two markers of one body (warning)",
        "It never changes: name markers of two bodies, or one marker alone to measure it from the ground.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[marker]]\nname = \"foot\"\nbody = \"bar\"\npoint = [0.0, 0.0]\n\n[[marker]]\nname = \"tip\"\nbody = \"bar\"\npoint = [1.0, 0.0]\n\n[[measure]]\nname = \"swing\"\ntype = \"angle\"\nmarkers = [\"foot\", \"tip\"]\n"
            ),
        ),
    ),
    entry(
        199,
        "An orientation is not quite a rotation (warning)",
        "The nearest rotation is taken: write more digits.",
        Example::Scene(
            "check -",
            block!("inertia = [1, 1, 1]\norientation = { quaternion = [1, 0.5, 0, 0] }\n"),
        ),
    ),
    entry(
        201,
        "The mechanism cannot be assembled",
        "No position of the bodies satisfies the joints that the message names: correct a place or a length.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\npoints = { ground = [0.0, 0.0], bar = [0.0, 0.0] }\n\n[[joint]]\nname = \"B\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\npoints = { ground = [5.0, 0.0], bar = [1.0, 0.0] }\n"
            ),
        ),
    ),
    entry(
        202,
        "The start is far from any that the joints allow",
        "Correct the positions of the bodies, or set `allow_correction = true` in `[start]`.",
        Example::Scene(
            "check -",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\npoints = { ground = [0.5, 0.0], bar = [0.0, 0.0] }\n"
            ),
        ),
    ),
    entry(
        203,
        "No velocities satisfy the joints and the given ones",
        "Leave out the velocities that the message names.",
        RARE,
    ),
    entry(
        204,
        "A type asks for something that the start does not have",
        "Correct the places of the joint or force that the message names.",
        RARE,
    ),
    entry(
        205,
        "A coordinate does not exist",
        "Name one as `body.angle`.",
        Example::Scene("check -", bar!("\n[start]\nkeep = [\"bar.z\"]\n")),
    ),
    entry(
        206,
        "The rows allow no velocities",
        "They depend on each other, or nearly, and ask for different velocities: correct or delete one of them.",
        RARE,
    ),
    entry(
        207,
        "The start of a large mechanism needs a correction",
        "Write positions that satisfy the joints.",
        Example::None("it needs a large scene"),
    ),
    entry(
        208,
        "The equations of the start have no solution in numbers",
        "Look for lengths or masses of very different sizes.",
        RARE,
    ),
    entry(
        209,
        "The origin of a frame is kept without its angle",
        "A frame away from the centre of mass moves as the body turns: keep the angle, or the angular velocity, too.",
        Example::Scene(
            "check -",
            bar!("centre = [0.5, 0.0]\n\n[start]\nkeep = [\"bar.x\"]\n"),
        ),
    ),
    entry(
        210,
        "Redundant rows require different motions",
        "Correct the drives or joints that the message names.",
        RARE,
    ),
    entry(
        211,
        "No motion begins at this singular start",
        "Begin at another configuration, or with other velocities.",
        RARE,
    ),
    entry(
        212,
        "The rank of the start is undecided",
        "Correct the misalignment that the message names, or state a tolerance.",
        RARE,
    ),
    entry(
        213,
        "Rows depend on each other so nearly that nothing can be moved",
        "Correct the misalignment, or delete one of the rows.",
        RARE,
    ),
    entry(
        214,
        "The end of the run is not stated",
        "Write `t_end` in `[simulate]`, or `--t-end`.",
        Example::Scene("simulate - --out run", bar!("")),
    ),
    entry(
        215,
        "The loads push along a freedom that second order excludes",
        "No finite reaction exists: remove the loads that the message names, support the freedom, or describe the small offset with which the mechanism carries them, such as the sag of a cable.",
        Example::Scene(
            "simulate - --out run --t-end 1",
            scene!(
                "gravity = [0.0, -9.81]\n\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\nposition = [0.5, 0.0]\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[joint]]\nname = \"B\"\ntype = \"distance\"\nbodies = [\"ground\", \"bar\"]\nat = [[2.0, 0.0], [1.0, 0.0]]\n"
            ),
        ),
    ),
    entry(
        220,
        "The state about which a motion is to be linearised is not steady",
        "Let `pfaff equilibrium SCENE --out DIR` find a start at rest and linearise that, or let dampers bring the mechanism there in a run and linearise at its end with `--at-time`. What no joint or spring ties to the ground, such as a robot on a free base, falls and has no place of rest: hold its base, or describe what carries it. A steady motion in a circle is steady in axes that turn: `--follow BODY.wz`.",
        Example::Scene(
            "linearise -",
            "[scene]\nname = \"bar\"\nspace = \"plane\"\ngravity = [0.0, -9.81]\n\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n",
        ),
    ),
    entry(
        221,
        "A force has a corner where it is to be differentiated",
        "Linearise beside the corner, or give the force a smooth function.",
        Example::None("it needs a force with a corner"),
    ),
    entry(
        222,
        "A coordinate of a linearisation does not exist, or others determine it",
        "Write it as BODY.angle, BODY.x or BODY.y, in space BODY.x to BODY.z and BODY.rx to BODY.rz; leave out those that the joints determine.",
        Example::Scene("linearise - --coordinates bar.tilt", bar!("")),
    ),
    entry(
        223,
        "A coordinate that is to be followed acts on the motion",
        "Follow only coordinates whose values do not matter, such as the place of a vehicle on a plane.",
        Example::None("it needs a steady motion"),
    ),
    entry(
        224,
        "No independent coordinates determine the state",
        "The configuration is singular: choose another one.",
        Example::None("it needs a singular configuration"),
    ),
    entry(
        225,
        "A start at rest is asked for, and something prescribes a velocity",
        "Let the function of the drive begin with rate zero, or leave the drive out with `active = false`.",
        Example::Scene(
            "equilibrium -",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n\n[[drive]]\nname = \"motor\"\njoint = \"A\"\ntype = \"angle\"\nmotion = { type = \"constant-rate\", rate = 1.0 }\n"
            ),
        ),
    ),
    entry(
        226,
        "A free motion is pushed wherever it goes, so nothing rests",
        "Add a spring that resists it, or a joint that holds it; the message says what pushes. A robot on a free base falls: hold its base.",
        Example::Scene(
            "equilibrium -",
            "[scene]\nname = \"stone\"\nspace = \"plane\"\ngravity = [0.0, -9.81]\n\n[[body]]\nname = \"stone\"\nmass = 1.0\ninertia = 0.1\n",
        ),
    ),
    entry(
        227,
        "No place of rest was found near the start",
        "Describe a start nearer to rest, or look whether there is one: a motor may be too strong.",
        Example::None("it needs a search that does not end"),
    ),
    entry(
        301,
        "A state is not one of the mechanism",
        "Give as many finite numbers as it has coordinates and velocities.",
        LIBRARY,
    ),
    entry(
        302,
        "The constraint matrix cannot be analysed",
        "Look for numbers that are not finite.",
        RARE,
    ),
    entry(
        303,
        "A part of the mechanism is too large for this question",
        "Ask about a smaller part; the message names it.",
        Example::None("it needs a large scene"),
    ),
    entry(
        304,
        "Rows that were to be dropped are not redundant",
        "Drop other rows: `pfaff analyze` lists the dependencies.",
        RARE,
    ),
    entry(
        310,
        "A question names something that does not exist",
        "Correct the name of the joint, component, body or row.",
        Example::Command("analyze - --make-unique no-such-joint"),
    ),
    entry(
        311,
        "A combination of reactions cannot be read",
        "Write it as `W3.N + W4.N`.",
        Example::Command("analyze - --combine W3.N+"),
    ),
    entry(
        312,
        "Reactions cannot be computed for this choice",
        "Make another choice, or give the numbers that the message asks for.",
        RARE,
    ),
    entry(
        313,
        "The change of units could not be examined",
        "The message says what is undecided.",
        RARE,
    ),
    entry(
        314,
        "The motion could not be analysed along its way",
        "The message says where it ends.",
        RARE,
    ),
    entry(
        315,
        "Rows to delete could not be determined",
        "Allow fewer rows or other ones.",
        RARE,
    ),
    entry(
        316,
        "A verdict could not be explained",
        "The verdict holds; its reason is undecided.",
        RARE,
    ),
    entry(
        317,
        "A question names something that is not active",
        "Ask about another reaction, or remove `active = false`.",
        Example::Scene(
            "analyze - --make-unique A",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\nactive = false\n"
            ),
        ),
    ),
    entry(
        401,
        "An option of the run is not possible",
        "Write a value that the message allows.",
        Example::Scene("simulate - --out run --t-end 1 --rtol 2", bar!("")),
    ),
    entry(
        402,
        "Two options of the run do not go together",
        "Leave one of them out.",
        RARE,
    ),
    entry(
        403,
        "The rows to drop cannot be dropped",
        "Drop as many rows as are redundant, one of each dependent set.",
        Example::Scene(
            "simulate - --out run --t-end 1 --drop 1",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        404,
        "A reaction is wanted of something that does not exist",
        "Correct the name.",
        LIBRARY,
    ),
    entry(
        410,
        "The kept rows became dependent",
        "The mechanism passes a singular configuration: begin elsewhere, or end before.",
        RARE,
    ),
    entry(
        411,
        "The independent coordinates no longer determine the others",
        "Use an explicit method, or a smaller `max_step`.",
        RARE,
    ),
    entry(
        412,
        "The system of an implicit step is singular",
        "Use another method.",
        RARE,
    ),
    entry(
        413,
        "A body without mass can move freely",
        "Give it mass or inertia, or constrain it.",
        Example::Scene(
            "simulate - --out run --t-end 1",
            scene!("\n[[body]]\nname = \"bar\"\nmass = 0.0\ninertia = 0.0\n"),
        ),
    ),
    entry(
        414,
        "A value became infinite or undefined",
        "Look for a function of time or a force that grows without bound; a bushing in space has no value where it is turned by more than 3 rad.",
        RARE,
    ),
    entry(
        415,
        "Positions could not be moved back onto the constraints",
        "Use a tighter tolerance or a smaller `max_step`.",
        RARE,
    ),
    entry(
        416,
        "A dropped row is violated",
        "The rows that implied it at the start do not imply it here: `pfaff analyze` lists them; correct the joints, or what drives among them prescribe.",
        RARE,
    ),
    entry(
        417,
        "Drives contradict each other later",
        "Correct what they prescribe.",
        RARE,
    ),
    entry(
        418,
        "A row is redundant at the singular start only",
        "Begin at another configuration.",
        RARE,
    ),
    entry(
        419,
        "Dependent coordinates were found on another branch",
        "Use a smaller `max_step` or another method.",
        RARE,
    ),
    entry(
        420,
        "A row of output is far from the path of its step",
        "Use another method, or a smaller `max_step`.",
        RARE,
    ),
    entry(
        421,
        "A constraint jumps",
        "Use a function of time that is continuous.",
        RARE,
    ),
    entry(
        422,
        "No step passes a singular configuration",
        "The constraints do not determine how the motion goes on.",
        RARE,
    ),
    entry(
        423,
        "No rows can be kept",
        "The kept rows are nearly dependent, and so are all others.",
        RARE,
    ),
    entry(
        424,
        "The equations of motion have no unique solution",
        "Look for bodies without mass.",
        RARE,
    ),
    entry(
        425,
        "A row misses by more than the stated tolerance explains",
        "Correct the dimensions of its joint, state the tolerance that the joint has, or end the run earlier.",
        RARE,
    ),
    entry(
        426,
        "A called function did not give a finite number",
        "The message names the drive or the body, the time and what came back; a function has to return finite numbers wherever it is asked, also beside the motion.",
        CALLED,
    ),
    entry(
        427,
        "A called function has no derivatives",
        "Use an explicit method, or give the drive a law as a text where derivatives are needed.",
        CALLED,
    ),
    entry(
        428,
        "Drives prescribe what no configuration satisfies",
        "End the run before that time, or prescribe a motion that turns back.",
        Example::Scene(
            "simulate - --out run",
            "[scene]\nname = \"winch\"\nspace = \"plane\"\n\n[[body]]\nname = \"bar\"\nmass = 1.0\ninertia = 0.1\nposition = [0.0, 0.5]\n\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [0.0, 0.0]\n\n[[joint]]\nname = \"rope\"\ntype = \"distance\"\nbodies = [\"ground\", \"bar\"]\nat = [[-2.0, 0.0], [0.0, 1.0]]\n\n[[drive]]\nname = \"winch\"\njoint = \"rope\"\ntype = \"length\"\nmotion = { type = \"constant-rate\", rate = 0.5 }\n\n[simulate]\nt_end = 3.0\n",
        ),
    ),
    entry(
        430,
        "The integration stopped",
        "Loosen the tolerance, raise `max_steps`, or use another method; the message says which.",
        Example::Scene(
            "simulate - --out run --t-end 10 --max-step 1 --max-steps 10",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        501,
        "A key to vary or to set is no number of the scene",
        "Write it as `body.bob.mass`, or as the name of a parameter.",
        Example::Scene("check - --set body.rod.mass=1", bar!("")),
    ),
    entry(
        502,
        "The values of a sweep cannot be read",
        "Write them as KEY=FROM:TO:N or KEY=A,B,C.",
        LIBRARY,
    ),
    entry(
        503,
        "No run of a sweep can begin",
        "Correct the scene, or choose other values.",
        Example::Scene(
            "sweep - --vary body.bar.mass=-1,-2 --out run",
            bar!("\n[simulate]\nt_end = 1.0\n"),
        ),
    ),
    entry(
        505,
        "The directory belongs to another sweep",
        "Take another directory, or remove its folder `shards`.",
        Example::None("it needs two sweeps"),
    ),
    entry(
        506,
        "The first line of a file of a sweep is damaged",
        "Remove the file; its runs are made again.",
        Example::None("it needs a damaged file"),
    ),
    entry(
        507,
        "There is no sweep in the directory",
        "Make its runs first.",
        Example::Command("sweep --merge . --out run"),
    ),
    entry(
        508,
        "Threads cannot be started",
        "Use fewer with `--threads`.",
        MACHINE,
    ),
    entry(
        509,
        "Two rows of one run differ",
        "Remove the file that is not to be trusted, and make its runs again.",
        Example::None("it needs machines that compute differently"),
    ),
    entry(
        510,
        "No number of the scene has a tolerance",
        "State one, as `--tolerance 1e-4` or in [scene], a body, a joint or a marker.",
        Example::Scene(
            "tolerance -",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        511,
        "The number of samples is out of its range",
        "Ask for at least one, and for no more than the message says.",
        Example::Scene(
            "tolerance - --tolerance 1e-4 --runs 0",
            bar!(
                "\n[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bar\"]\nat = [1.0, 0.0]\n"
            ),
        ),
    ),
    entry(
        512,
        "A mechanism is too large for samples of its tolerances",
        "Make a scene of a part of it.",
        Example::None("it needs a large scene"),
    ),
    entry(
        513,
        "A number cannot vary as far as it is asked to",
        "Correct the interval: the scene has to be right at both of its ends.",
        Example::Scene("tolerance - --vary body.bar.mass=±200%", bar!("")),
    ),
    entry(
        601,
        "A file to import is not XML",
        "Correct it at the mark: every element needs its end, every attribute its quotes.",
        Example::Scene("import - --out -", "<mujoco>\n  <worldbody>\n</mujoco>\n"),
    ),
    entry(
        602,
        "A file to import has a format that is not known",
        "MJCF has the root `<mujoco>`, URDF `<robot>`, SDF `<sdf>`.",
        Example::Scene("import - --out -", "<svg/>\n"),
    ),
    entry(
        603,
        "A file to import is refused unread",
        "It declares a document type, which may define entities, or it is too large or too deep: remove the declaration, or split the file.",
        Example::Scene(
            "import - --out -",
            "<!DOCTYPE mujoco [<!ENTITY a \"aaaa\">]>\n<mujoco model=\"&a;\"/>\n",
        ),
    ),
    entry(
        604,
        "An element of a file to import lacks something",
        "Add the attribute or element that the message names.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body>\n      <inertial pos=\"0 0 0\"/>\n    </body>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
    entry(
        605,
        "A value of a file to import is not what is expected",
        "Write numbers that are finite, as many as are asked for, or one of the words that the message names.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body pos=\"0 0\"/>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
    entry(
        606,
        "A file to import refers to something that is not there",
        "Correct the name of the body, joint, site, class or keyframe.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body name=\"arm\"/>\n  </worldbody>\n  <equality>\n    <weld body1=\"leg\"/>\n  </equality>\n</mujoco>\n",
        ),
    ),
    entry(
        607,
        "A name occurs twice in a file to import",
        "Rename one of the two: references to the name have two meanings.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body name=\"arm\"/>\n    <body name=\"arm\"/>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
    entry(
        608,
        "A file to import has something that changes the mechanism and is not read",
        "Expand it with the tool that the file is for, as MuJoCo does when it saves a model, and import the result.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <composite type=\"cable\"/>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
    entry(
        609,
        "Bodies and joints of a file to import do not fit together",
        "The message names what is at odds: a body without a place, a joint of a body with itself, no body at all.",
        Example::Scene("import - --out -", "<mujoco/>\n"),
    ),
    entry(
        610,
        "A number of a file to import is out of its range",
        "Masses, sizes and stiffnesses are not negative, and directions and quaternions are not zero.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body quat=\"0 0 0 0\"/>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
    entry(
        611,
        "A file is not included",
        "Included files have to lie in the folder of the file that is imported, or below it, each once.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <include file=\"../arm.xml\"/>\n</mujoco>\n",
        ),
    ),
    entry(
        612,
        "A file of loop closures cannot be read",
        "It has the keys `closed_loop`, pairs of links that coincide, and `type`, for each of them `3d` or `6d`.",
        Example::None("it needs a second file"),
    ),
    entry(
        613,
        "Loops of a file to import are open at every pose that is tried",
        "Give a pose near which they close with `--pose`, or correct lengths: the message names the loop with the largest gap.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body name=\"arm\">\n      <joint name=\"hinge\"/>\n      <geom size=\"0.1\"/>\n      <site name=\"tip\" pos=\"1 0 0\"/>\n    </body>\n    <site name=\"far\" pos=\"2 0 0\"/>\n  </worldbody>\n  <equality>\n    <connect site1=\"tip\" site2=\"far\"/>\n  </equality>\n</mujoco>\n",
        ),
    ),
    entry(
        614,
        "A file to import has a name that its format does not know",
        "Correct the attribute or element: one that is misspelt is not read, and another mass or another joint comes of it.",
        Example::Scene(
            "import - --out -",
            "<mujoco>\n  <worldbody>\n    <body>\n      <geom size=\"0.1\" desnity=\"20\"/>\n    </body>\n  </worldbody>\n</mujoco>\n",
        ),
    ),
];
