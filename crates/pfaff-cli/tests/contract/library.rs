//! The results of the library equal the files of the command: the format is the same, key by key
//! and value by value.

use std::ops::ControlFlow;

use pfaff::model::System;
use pfaff::prelude::*;
use pfaff::report::{OutputDirectory, write_json};
use serde_json::Value;

use super::singular::flat_cranks;
use super::{Folder, ROBOT, pfaff, stdout, with_scene};

fn study(name: &str, text: &str) -> Study {
    let study = Study::read(name, text, &Registry::standard(), &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}"))
}

fn written(document: &impl serde::Serialize) -> String {
    let mut out = Vec::new();
    write_json(&mut out, document).expect("a vector takes all");
    String::from_utf8(out).expect("UTF-8")
}

fn robot() -> String {
    std::fs::read_to_string(ROBOT).expect("it is there")
}

#[test]
fn an_analysis_is_the_one_of_the_command() {
    let text = robot();
    let sums = ["W3.N + W4.N".to_owned()];
    let output = pfaff(&["analyze", ROBOT, "--json", "--combine", &sums[0]]);
    let study = study(ROBOT, &text);
    let start = study.analyse(0.0, None).expect("a start");
    let document = start.document(&sums).expect("verdicts");
    assert_eq!(written(&document), stdout(&output));
}

#[test]
fn a_journey_is_the_one_of_the_command() {
    let output = pfaff(&["analyze", ROBOT, "--json", "--along", "1"]);
    let study = study(ROBOT, &robot());
    let start = study.analyse(0.0, None).expect("a start");
    let mut document = start.document(&[]).expect("verdicts");
    let along_motion = study
        .verdicts_along_motion(Some(1.0), |_| {})
        .expect("it moves");
    along_motion.add_to(&mut document, study.prepared.mechanism.layout());
    assert_eq!(written(&document), stdout(&output));
}

/// In the singular configuration of the cranks the redundancy is larger than at other
/// configurations, and the document warns.
#[test]
fn warnings_of_a_singular_configuration_are_those_of_the_command() {
    let flat = flat_cranks(&[0.0, 1.0]);
    let output = with_scene(&["analyze", "-", "--json"], &flat);
    let study = study("-", &flat);
    let start = study.analyse(0.0, None).expect("a start");
    let document = start.document(&[]).expect("verdicts");
    assert!(document.warnings[0].contains("this singular configuration only"));
    assert_eq!(written(&document), stdout(&output));
}

#[test]
fn the_summary_of_a_run_is_the_one_of_the_command() {
    let folder = Folder::new("library-summary");
    let end = ["--t-end", "0.5"];
    let arguments = ["simulate", ROBOT, "--json", "--out", folder.text()];
    let output = pfaff(&[&arguments[..], &end].concat());
    let timeless = |text: &str| {
        let mut value: Value = serde_json::from_str(text).expect("JSON");
        value["wall_seconds"] = 0.into();
        // The head belongs to documents, and the summary may be a part of a document.
        let object = value.as_object_mut().expect("an object");
        assert_eq!(object.remove("format"), Some(2.into()));
        assert_eq!(
            object.remove("version"),
            Some(env!("CARGO_PKG_VERSION").into())
        );
        value
    };
    let of_command = timeless(&stdout(&output));
    let overrides = RunOptions {
        t_end: Some(0.5),
        ..RunOptions::default()
    };
    let text = robot();
    let study = Study::read(ROBOT, &text, &Registry::standard(), &overrides).expect("a scene");
    let directory = OutputDirectory::create(folder.0.join("again")).expect("a folder");
    let run = study.simulate_into(&directory, |_| ControlFlow::Continue(()));
    assert_eq!(timeless(&written(&run.expect("a run"))), of_command);
    // The result is the same as plain data, including the rows, without a folder.
    let motion = study.motion(study.options.as_ref().expect("a run"));
    // The comparison goes through the text: a parsed number may differ from the printed one in its
    // last bit.
    let motion = serde_json::to_string(&motion.expect("a run")).expect("plain data");
    let motion: Value = serde_json::from_str(&motion).expect("JSON");
    let keys = |value: &Value| -> Vec<String> {
        let object = value.as_object().expect("an object");
        object.keys().cloned().collect()
    };
    assert_eq!(keys(&motion["summary"]), keys(&of_command));
    for key in ["reactions", "steps", "t_end", "partial"] {
        assert_eq!(motion["summary"][key], of_command[key], "{key}");
    }
}
