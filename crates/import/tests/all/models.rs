//! SDF: several models of a file, models within models, and included models.

use std::path::PathBuf;

use pfaff_import::{Folder, ImportedScene, Options, Refusal};

use super::{first, import_text, numbers, read, refused, value};

/// Allowed difference of a length: some roundings of numbers of size 1.
const ROUNDING: f64 = 1e-15;

/// A folder of files, which is removed at the end of a test.
struct Directory(PathBuf);

impl Directory {
    fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let name = format!("pfaff-models-{name}-{}", std::process::id());
        let own = Self(std::env::temp_dir().join(name));
        for (file, text) in files {
            own.write(file, text);
        }
        own
    }

    fn write(&self, file: &str, text: &str) {
        let path = self.0.join(file);
        let folder = path.parent().expect("a folder");
        std::fs::create_dir_all(folder).expect("writable");
        std::fs::write(path, text).expect("writable");
    }

    fn import(&self, text: &str) -> Result<ImportedScene, Box<Refusal>> {
        let options = Options {
            folder: Folder::At(self.0.clone()),
            ..Options::default()
        };
        pfaff_import::import("world.sdf", text, &options)
    }

    fn imported(&self, text: &str) -> ImportedScene {
        let done = self.import(text);
        done.unwrap_or_else(|refusal| panic!("{:?}", refusal.diagnostics))
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn choosing(model: &str) -> Options {
    Options {
        model: Some(model.to_owned()),
        ..Options::default()
    }
}

fn assert_at(done: &ImportedScene, body: &str, expected: [f64; 3]) {
    let found = value(&done.scene, "body", body, "position");
    let found = numbers(&found.unwrap_or_else(|| panic!("{body}:\n{}", done.scene)));
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() <= ROUNDING, "{body}: {found:?}");
    }
}

const MASS: &str = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia>\
    </inertial>";

/// A link `rod` on a hinge of the ground.
fn pendulum(name: &str, x: f64, more: &str) -> String {
    format!(
        "<model name='{name}'><pose>{x} 0 0 0 0 0</pose><link name='rod'><pose>0 0 -1 0 0 0</pose>\
         {MASS}</link><joint name='hinge' type='revolute'><parent>world</parent><child>rod</child>\
         </joint>{more}</model>\n"
    )
}

fn world(inner: &str) -> String {
    format!("<sdf version='1.9'><world name='hall'>\n{inner}</world></sdf>")
}

/// Two pendulums with equal names, and a bar between them that belongs to the second.
fn two() -> String {
    let bar = format!(
        "<link name='bar'>{MASS}</link><joint name='pin' type='ball'><parent>rod</parent>\
         <child>bar</child></joint>"
    );
    let ball = "<joint name='end' type='ball'><pose relative_to='a::rod'/><parent>a::rod</parent>\
                <child>b::bar</child></joint>\n";
    world(&(pendulum("a", 1.0, "") + &pendulum("b", -1.0, &bar) + ball))
}

#[test]
fn models_of_a_world_are_one_scene() {
    let done = import_text(&two(), &Options::default());
    assert_eq!(done.counts, [3, 4]);
    assert!(done.scene.contains("name = \"hall\""));
    assert_at(&done, "a/rod", [1.0, 0.0, -1.0]);
    assert_at(&done, "b/rod", [-1.0, 0.0, -1.0]);
    let end = value(&done.scene, "joint", "end", "bodies");
    assert_eq!(end.as_deref(), Some("[\"a/rod\", \"bar\"]"));
    let points = value(&done.scene, "joint", "end", "points").expect("points");
    assert!(points.contains("\"bar\" = [2.0, 0.0, -1.0]"), "{points}");
    for joint in ["a/hinge", "b/hinge", "pin"] {
        assert!(
            value(&done.scene, "joint", joint, "type").is_some(),
            "{joint}"
        );
    }
    read(&done);
}

#[test]
fn one_model_is_chosen() {
    let done = import_text(&two(), &choosing("b"));
    assert_eq!(done.counts, [2, 2]);
    assert_at(&done, "rod", [-1.0, 0.0, -1.0]);
    let left: Vec<(usize, &str)> = done.omissions.iter().map(|o| (o.line, o.kind)).collect();
    let expected = [
        (2, "models that are not chosen"),
        (4, "joints of models that are not chosen"),
    ];
    assert_eq!(left, expected);
    let refusal = pfaff_import::import("w.sdf", &two(), &choosing("c")).expect_err("refused");
    assert_eq!(
        first(&refusal),
        ("P0606".into(), 1, "the file has no model `c`".into())
    );
    assert_eq!(
        refusal.diagnostics[0].help.as_deref(),
        Some("known are `a`, `b`")
    );
    let other = "<robot name='r'><link name='a'/></robot>";
    let refusal = pfaff_import::import("r.urdf", other, &choosing("r")).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0608");
}

/// An include that does not lead to a file is reported only if its model is read.
#[test]
fn only_the_chosen_model_is_included() {
    let text = world(
        &("<include><uri>model://sun</uri></include>\n".to_owned() + &pendulum("a", 0.0, "")),
    );
    assert_eq!(first(&refused(&text)).0, "P0611");
    assert_eq!(import_text(&text, &choosing("a")).counts, [1, 1]);
}

/// The first of two models with one name contains a model that the second does not contain.
#[test]
fn a_name_of_two_models_is_refused() {
    let inner = format!("<model name='b'><link name='c'>{MASS}</link></model>");
    let first_model = pendulum("a", 0.0, &inner);
    let text = world(&(first_model + &pendulum("a", 1.0, "") + &pendulum("d", 2.0, "")));
    let (code, line, message) = first(&refused(&text));
    assert_eq!((code.as_str(), line), ("P0607", 3), "{message}");
}

#[test]
fn static_models_belong_to_the_ground() {
    let wall = format!(
        "<model name='wall'><static>true</static><pose>0 2 0 0 0 0</pose><link name='panel'>{MASS}\
         </link><frame name='edge'><pose>0 0 1 0 0 0</pose></frame></model>"
    );
    let door = format!("<model name='door'><link name='leaf'>{MASS}</link></model>");
    let hinge = "<joint name='hinge' type='revolute'><parent>wall::edge</parent>\
                 <child>door::leaf</child></joint>";
    let done = import_text(&world(&(wall + &door + hinge)), &Options::default());
    assert_eq!(done.counts, [1, 1]);
    let bodies = value(&done.scene, "joint", "hinge", "bodies");
    assert_eq!(bodies.as_deref(), Some("[\"ground\", \"leaf\"]"));
    let of = |key| value(&done.scene, "marker", "edge", key);
    assert_eq!(of("body").as_deref(), Some("\"ground\""));
    assert_eq!(of("point").as_deref(), Some("[0.0, 2.0, 1.0]"));
}

/// A detachable joint may hold a link of another model.
#[test]
fn a_plugin_holds_another_model() {
    let plugin = |link: &str| {
        format!(
            "<plugin name='d' filename='gz-sim-detachable-joint-system'><parent_link>rod</parent_link>\
             <child_model>box</child_model><child_link>{link}</child_link></plugin>"
        )
    };
    let text = |link| {
        let cube = format!("<model name='box'><link name='cube'>{MASS}</link></model>\n");
        world(&(cube + &pendulum("a", 1.0, &plugin(link))))
    };
    let done = import_text(&text("cube"), &Options::default());
    // The link has no other joint, so it is a part of the rod.
    let held = value(&done.scene, "marker", "cube", "body");
    assert_eq!((done.counts, held.as_deref()), ([1, 1], Some("\"rod\"")));
    let (code, line, message) = first(&refused(&text("cub")));
    assert_eq!((code.as_str(), line), ("P0606", 3), "{message}");
}

#[test]
fn models_are_nested() {
    let nested = |depth: usize| {
        let (open, close) = ("<model name='m'><pose>0 0 1 0 0 0</pose>", "</model>");
        let link = format!("<link name='rod'>{MASS}</link>");
        let (open, close) = (open.repeat(depth), close.repeat(depth));
        format!("<sdf version='1.9'>\n{open}{link}{close}</sdf>")
    };
    let done = import_text(&nested(32), &Options::default());
    assert_at(&done, "rod", [0.0, 0.0, 32.0]);
    let (code, line, message) = first(&refused(&nested(33)));
    assert_eq!((code.as_str(), line), ("P0609", 2));
    assert!(message.contains("more than 32 deep"), "{message}");
    // The names of a model within the model begin with its name.
    let elbow = "<joint name='elbow' type='revolute'><parent>rod</parent><child>hand::rod</child>\
                 <axis><xyz expressed_in='hand'>0 0 1</xyz><mimic joint='hand::turn'>\
                 <multiplier>2</multiplier></mimic></axis></joint>";
    let hand = format!(
        "<model name='hand'><pose relative_to='rod'>0 0 -1 0 1.5707963267948966 0</pose>\
         <link name='rod'>{MASS}</link><link name='claw'>{MASS}</link><joint name='turn' \
         type='revolute'><parent>rod</parent><child>claw</child></joint></model>"
    );
    let text = world(&pendulum("arm", 1.0, &(hand + elbow)));
    let done = import_text(&text, &Options::default());
    assert_at(&done, "arm/hand/rod", [1.0, 0.0, -2.0]);
    let axis = numbers(&value(&done.scene, "joint", "elbow", "axis").expect("an axis"));
    assert!((axis[0] - 1.0).abs() <= ROUNDING, "{axis:?}");
    let ratio = value(&done.scene, "joint", "elbow follows turn", "ratio");
    assert_eq!(ratio.as_deref(), Some("2.0"));
}

const CONFIG: &str = "<model><name>arm</name><sdf version='1.9'>old.sdf</sdf>\
    <sdf version='1.10'>new.sdf</sdf></model>";

/// The tip has a link 0.1 m from its origin and a joint about its axis z.
fn tip() -> String {
    format!(
        "<sdf version='1.10'><model name='tip'><link name='pin'><pose>0.1 0 0 0 0 0</pose>{MASS}\
         </link><link name='needle'>{MASS}</link><joint name='wrist' type='revolute'>\
         <parent>pin</parent><child>needle</child><axis><xyz expressed_in='__model__'>0 0 1</xyz>\
         </axis></joint></model></sdf>"
    )
}

/// The arm has a rod and the merged tip, which is rotated by 90° about x.
fn arm() -> String {
    format!(
        "<sdf version='1.10'><model name='arm'><link name='rod'><pose>0.2 0 0 0 0 0</pose>{MASS}\
         </link><frame name='top'><pose>0.5 0 0 0 0 0</pose></frame><include merge='true'>\
         <uri>../parts/tip.sdf</uri><pose relative_to='rod'>0 0 -1 1.5707963267948966 0 0</pose>\
         </include><joint name='grip' type='revolute'><parent>rod</parent><child>pin</child></joint>\
         </model></sdf>"
    )
}

#[test]
fn included_models_are_placed() {
    let files = [
        ("arm/model.config", CONFIG),
        ("arm/new.sdf", &arm()),
        ("parts/tip.sdf", &tip()),
    ];
    let folder = Directory::new("placed", &files);
    // The frame `top` of the right arm is at the pose, so its origin is 0.5 m behind it.
    let text = world(
        "<include><uri>model://arm</uri></include><include><uri>arm</uri><name>right</name>\
         <pose>0 0 2 0 0 1.5707963267948966</pose><placement_frame>top</placement_frame></include>\
         <joint name='between' type='ball'><parent>arm::rod</parent><child>right::pin</child></joint>",
    );
    let done = folder.imported(&text);
    assert_eq!(done.counts, [6, 5]);
    assert_at(&done, "arm/rod", [0.2, 0.0, 0.0]);
    assert_at(&done, "arm/pin", [0.3, 0.0, -1.0]);
    assert_at(&done, "right/rod", [0.0, -0.3, 2.0]);
    assert_at(&done, "right/pin", [0.0, -0.2, 1.0]);
    // The axis z of the merged tip is −y of the arm.
    let [pin, axis] = ["body", "joint"].map(|table| match table {
        "body" => value(&done.scene, "body", "arm/pin", "orientation"),
        _ => value(&done.scene, "joint", "arm/wrist", "axis"),
    });
    let (_, turned) = pin
        .as_deref()
        .and_then(|q| q.split_once("quaternion = "))
        .expect("turned");
    assert!((numbers(turned)[1] - 0.5_f64.sqrt()).abs() <= ROUNDING);
    assert_eq!(numbers(&axis.expect("an axis")), [0.0, 0.0, 1.0]);
    read(&done);
    // The placement frame of a merged model is at the pose, too.
    let placed = arm().replace(
        "</include>",
        "<placement_frame>pin</placement_frame></include>",
    );
    folder.write("arm/new.sdf", &placed);
    let done = folder.imported(&world("<include><uri>model://arm</uri></include>"));
    assert_at(&done, "pin", [0.2, 0.0, -1.0]);
    // A static include belongs to the ground.
    let fixed = "<include><uri>model://arm</uri><static>true</static></include>";
    let done = folder.imported(&world(&(pendulum("a", 0.0, "") + fixed)));
    assert_eq!(done.counts, [1, 1]);
}

#[test]
fn includes_without_a_file_are_refused_by_name() {
    let files = [
        ("inner/robot.sdf", "<robot/>"),
        ("inner/empty.sdf", "<sdf version='1.9'/>"),
        ("inner/sun.sdf", "<sdf version='1.9'><light/></sdf>"),
        (
            "inner/wrong.sdf",
            "<sdf version='1.9'><model><lnik/></model></sdf>",
        ),
        ("bad/model.config", "<model/>"),
        ("none/other.sdf", ""),
    ];
    let folder = Directory::new("refused", &files);
    let include = |uri: &str| format!("<include><uri>{uri}</uri></include>\n");
    for (uri, code, message, help) in [
        (
            "model://claw",
            "P0611",
            "does not contain it",
            "copy the folder `claw`",
        ),
        (
            "https://fuel.org/1.0/models/claw/2",
            "P0611",
            "only `model://`",
            "write `model://claw`",
        ),
        ("../claw.sdf", "P0611", "outside of the folder", ""),
        ("/etc/passwd", "P0611", "outside of the folder", ""),
        ("model://../claw", "P0611", "outside of the folder", ""),
        ("", "P0611", "outside of the folder", ""),
        ("claw.sdf", "P0611", "cannot be read", ""),
        ("none", "P0611", "cannot be read", ""),
        ("bad", "P0611", "`bad/model.config` has no `<sdf>`", ""),
        ("inner/robot.sdf", "P0611", "its root is `<robot>`", ""),
        ("inner/empty.sdf", "P0611", "needs one `<model>`", ""),
    ] {
        let refusal = folder.import(&world(&include(uri))).expect_err("refused");
        let (found, line, text) = first(&refusal);
        assert_eq!((found.as_str(), line), (code, 2), "{uri}: {text}");
        assert!(
            text.contains(message) && text.contains(uri),
            "{uri}: {text}"
        );
        let advice = refusal.diagnostics[0].help.as_deref().unwrap_or_default();
        assert!(advice.contains(help), "{uri}: {advice}");
    }
    // A fault in an included file is reported in this file.
    let refusal = folder
        .import(&world(&include("inner/wrong.sdf")))
        .expect_err("refused");
    assert_eq!(
        (first(&refusal).0.as_str(), refusal.file.as_str()),
        ("P0614", "inner/wrong.sdf")
    );
    // A file with only lights has no model.
    let done = folder.imported(&world(
        &(include("inner/sun.sdf") + &pendulum("a", 0.0, "")),
    ));
    assert_eq!(done.counts, [1, 1]);
    // A text from standard input has no folder.
    let (code, _, message) = first(&refused(&world(&include("model://claw"))));
    assert_eq!(code, "P0611");
    assert!(message.contains("standard input"), "{message}");
    let merged = "<include merge='true'><uri>inner/empty.sdf</uri></include>";
    folder.write(
        "inner/empty.sdf",
        "<sdf version='1.9'><model name='m'/></sdf>",
    );
    let refusal = folder.import(&world(merged)).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0608");
}

#[test]
fn includes_without_end_are_refused() {
    let folder = Directory::new("endless", &[]);
    let two = |file: &str| {
        let include = format!("<include><uri>{file}</uri><name>NAME</name></include>");
        let [a, b] = ["a", "b"].map(|name| include.replace("NAME", name));
        format!("<sdf version='1.9'><model name='m'>{a}{b}</model></sdf>")
    };
    folder.write("self.sdf", &two("self.sdf"));
    folder.write("one.sdf", &two("other.sdf"));
    folder.write("other.sdf", &two("one.sdf"));
    for file in ["self.sdf", "one.sdf"] {
        let refusal = folder.import(&two(file)).expect_err("refused");
        let (code, _, message) = first(&refusal);
        assert_eq!(code, "P0611");
        assert!(
            message.contains("include each other without end"),
            "{message}"
        );
    }
    // Each of 30 files includes the next file twice, which would give 2^30 inclusions.
    for k in 0..30 {
        folder.write(&format!("{k}.sdf"), &two(&format!("{}.sdf", k + 1)));
    }
    folder.write("30.sdf", "<sdf version='1.9'><model name='m'/></sdf>");
    let refusal = folder.import(&two("0.sdf")).expect_err("refused");
    let (code, _, message) = first(&refusal);
    assert_eq!(code, "P0611");
    assert!(message.contains("together have more than"), "{message}");
}
