//! Files that would use up memory or the stack, or that include other files.

use pfaff_import::{Folder, Options};

use super::{first, refused};

#[test]
fn hostile_files_are_refused() {
    let laughs =
        "<!DOCTYPE mujoco [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<mujoco model=\"&b;\"/>";
    let external =
        "<!DOCTYPE r [<!ENTITY f SYSTEM \"file:///etc/passwd\">]><mujoco model=\"&f;\"/>";
    let deep = format!("<mujoco>{}", "<worldbody><body>".repeat(200));
    let deeper = "<a>".repeat(1_000_000);
    let large = format!("<mujoco>{}</mujoco>", " ".repeat(17 << 20));
    let wide = format!("<mujoco>{}</mujoco>", "<a/>".repeat(1 << 20));
    for text in [laughs, external, &deep, &deeper, &large, &wide] {
        assert_eq!(first(&refused(text)).0, "P0603", "{}", &text[..60]);
    }
    for (text, code) in [
        ("", "P0601"),
        ("<mujoco", "P0601"),
        ("<mujoco></robot>", "P0601"),
        ("<mujoco model=\"&b;\"/>", "P0601"),
        ("<svg/>", "P0602"),
        ("<mujoco/>", "P0609"),
    ] {
        assert_eq!(first(&refused(text)).0, code, "{text}");
    }
}

/// The cases are an element with 64 000 attributes or name spaces, and a list of loops with 64 000
/// keys. In some cases a value, a comment or a section in the element looks like the end of the
/// element.
#[test]
fn many_attributes_cost_no_time() {
    let many = |what: &str| -> String { (0..64_000).map(|k| format!("{what}{k}='1' ")).collect() };
    let begin = std::time::Instant::now();
    for text in [
        format!("<robot {}/>", many("a")),
        format!("<robot b='>' c=\"'/>\" {}/>", many("a")),
        format!("<!-- ' --><robot {}/>", many("a")),
        format!(
            "<robot><![CDATA[ <'> ]]><?x '?><link {}/></robot>",
            many("a")
        ),
        format!("<robot {}/>", many("xmlns:a")),
        format!("<robot>{}</robot>", "<link xmlns:a='b'/>".repeat(64_000)),
    ] {
        assert_eq!(first(&refused(&text)).0, "P0603", "{}", &text[..40]);
    }
    let robot = "<robot name='r'><link name='base'/><link name='rod'><inertial><mass value='1'/>\
                 <inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
                 <joint name='j' type='revolute'><parent link='base'/><child link='rod'/>\
                 <axis xyz='0 0 1'/></joint></robot>";
    let keys: String = (0..64_000).map(|k| format!("key{k}: 1\n")).collect();
    let options = Options {
        loops: Some((
            "loops.yaml".to_owned(),
            keys + "closed_loop: []\ntype: []\n",
        )),
        ..Options::default()
    };
    let done = pfaff_import::import("robot.urdf", robot, &options).expect("imported");
    assert_eq!(done.omissions.len(), 64_000);
    // The elements are in one line, and each of them is omitted.
    let left = "<x/>".repeat(64_000);
    let wide = robot.replacen("<link", &format!("{left}<link"), 1);
    let done = pfaff_import::import("robot.urdf", &wide, &Options::default()).expect("imported");
    assert_eq!(done.omissions.len(), 64_000);
    // The poses form one circle of references.
    let frame = |k: usize| {
        let next = (k + 1) % 8_000;
        format!("<frame name='f{k}'><pose relative_to='f{next}'>0 0 0 0 0 0</pose></frame>")
    };
    let circle: String = (0..8_000).map(frame).collect();
    let circle =
        format!("<sdf version='1.7'><model name='m'><link name='l'/>{circle}</model></sdf>");
    assert_eq!(first(&refused(&circle)).0, "P0609");
    // The time is proportional to the length of the text and less than a second. A comparison of
    // all pairs would take minutes.
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
}

/// Time limit for files of a megabyte, without optimisation and on a busy machine.
const PATIENCE: std::time::Duration = std::time::Duration::from_secs(60);

/// The file has the largest allowed number of attributes, and quotes within quotes.
#[test]
fn attributes_within_the_limit_are_read() {
    let many: String = (0..250)
        .map(|k| format!("a{k}='\"<' ").replace('<', ""))
        .collect();
    let text = format!("<robot name='r' {many}/>");
    // The robot is empty, but it was read.
    assert_eq!(first(&refused(&text)).0, "P0609");
}

/// The file has the largest allowed depth, and is read on the stack of a thread.
#[test]
fn deep_files_are_read() {
    let (open, close) = (
        "<body><joint/><geom size='0.1'/>".repeat(290),
        "</body>".repeat(290),
    );
    let text = format!("<mujoco><worldbody>{open}{close}</worldbody></mujoco>");
    let done = pfaff_import::import("deep.xml", &text, &Options::default()).expect("imported");
    assert_eq!(done.counts, [290, 290]);
}

#[test]
fn includes_stay_in_their_folder() {
    let folder = std::env::temp_dir().join(format!("pfaff-import-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("in")).expect("writable");
    std::fs::write(folder.join("outside.xml"), "<mujoco/>").expect("writable");
    std::fs::write(
        folder.join("in/self.xml"),
        "<mujoco><include file='self.xml'/></mujoco>",
    )
    .expect("writable");
    let at = Options {
        folder: Folder::At(folder.join("in")),
        ..Options::default()
    };
    let outside = folder.join("outside.xml").display().to_string();
    for file in [
        "../outside.xml",
        "missing.xml",
        "",
        ".",
        &outside,
        "/etc/passwd",
    ] {
        let text = format!("<mujoco><include file='{file}'/></mujoco>");
        let refusal = pfaff_import::import("model.xml", &text, &at).expect_err("refused");
        assert_eq!(first(&refusal).0, "P0611", "{file}");
        let refusal = refused(&text);
        assert_eq!(first(&refusal).0, "P0611", "{file} of standard input");
    }
    let text = "<mujoco><include file='self.xml'/></mujoco>";
    let refusal = pfaff_import::import("model.xml", text, &at).expect_err("refused");
    assert_eq!(
        (first(&refusal).0.as_str(), refusal.file.as_str()),
        ("P0611", "self.xml")
    );
    // Each file includes itself twice, which would give 2^300 inclusions.
    let twice = "<mujoco><include file='twice.xml'/><include file='twice.xml'/></mujoco>";
    std::fs::write(folder.join("in/twice.xml"), twice).expect("writable");
    let refusal = pfaff_import::import("model.xml", twice, &at).expect_err("refused");
    assert_eq!(first(&refusal).0, "P0611");
    // The limit is 64 files.
    let mut all = String::new();
    for k in 0..65 {
        std::fs::write(folder.join(format!("in/{k}.xml")), "<mujoco/>").expect("writable");
        all += &format!("<include file='{k}.xml'/>");
    }
    let refusal = pfaff_import::import("model.xml", &format!("<mujoco>{all}</mujoco>"), &at);
    let (code, _, message) = first(&refusal.expect_err("refused"));
    assert_eq!(code, "P0611");
    assert!(message.contains("more than 64 files"), "{message}");
    let fewer = all.replace("<include file='64.xml'/>", "");
    let refusal = pfaff_import::import("model.xml", &format!("<mujoco>{fewer}</mujoco>"), &at);
    assert_eq!(first(&refusal.expect_err("no body")).0, "P0609");
    std::fs::remove_dir_all(&folder).expect("removable");
}

#[test]
fn problems_are_counted() {
    let bodies = "<body pos='1'/>".repeat(300);
    let refusal = refused(&format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>"));
    assert_eq!(refusal.diagnostics.len(), 100);
    let help = refusal.diagnostics[99].help.as_deref().expect("a count");
    assert!(help.contains("200 more problems"), "{help}");
}

#[test]
fn numbers_have_bounds() {
    for number in ["1e61", "-1e300", "nan", "1e999", "0x10", "1,5", "--1"] {
        let text = format!("<mujoco><worldbody><body pos='{number} 0 0'/></worldbody></mujoco>");
        assert_eq!(first(&refused(&text)).0, "P0605", "{number}");
    }
}
