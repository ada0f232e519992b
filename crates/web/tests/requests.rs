//! Requests as a page sends them, on the machine of the tests.

use std::f64::consts::FRAC_PI_2;

use serde_json::{Value, json};

/// Sends a request through the raw exports' buffer, and returns the reply.
fn sent(request: &Value) -> Value {
    serde_json::from_str(&pfaff_web::answer(request.to_string().as_bytes())).expect("JSON")
}

const PENDULUM: &str = r#"[scene]
name = "µ-pendulum"
space = "plane"
gravity = [0.0, -9.81]

[[body]]
name = "bob"   # heavy
mass = 1.0
inertia = 0.1
position = [1.0, 0.0]

[[joint]]
name = "pivot"
type = "revolute"
bodies = ["ground", "bob"]
at = [0.0, 0.0]
"#;

/// Offset in UTF-16 units of the end of a part of a text.
fn after(text: &str, part: &str) -> usize {
    let end = text.find(part).expect("the part") + part.len();
    text[..end].encode_utf16().count()
}

fn labels(reply: &Value) -> Vec<&str> {
    let options = reply["done"]["options"].as_array().expect("options");
    options
        .iter()
        .map(|o| o["label"].as_str().expect("a label"))
        .collect()
}

fn complete(text: &str, part: &str) -> Value {
    sent(&json!({ "call": "complete", "text": text, "offset": after(text, part) }))
}

#[test]
fn a_question_is_answered_with_its_document_and_its_text() {
    let reply = sent(&json!({
        "call": "ask", "question": "analyze", "scenes": [{ "name": "p.toml", "text": PENDULUM }],
    }));
    assert_eq!(reply["done"]["document"]["rank"], 2);
    assert_eq!(reply["done"]["complete"], true);
    assert!(
        reply["done"]["text"]
            .as_str()
            .is_some_and(|text| text.contains("pivot"))
    );
}

#[test]
fn wrong_requests_are_refused_by_name() {
    let reply = sent(&json!({ "call": "ask", "question": "analyse", "scenes": [] }));
    let error = reply["refused"]["error"].as_str().expect("an error");
    assert!(error.contains("did you mean `analyze`?"), "{error}");
    let reply = sent(&json!({ "call": "answer" }));
    assert!(
        reply["refused"]["error"]
            .as_str()
            .is_some_and(|e| e.contains("unknown variant"))
    );
    let reply: Value = serde_json::from_str(&pfaff_web::answer(b"\xff{")).expect("JSON");
    assert!(reply["refused"]["error"].is_string());
}

#[test]
fn marks_are_in_utf16_units() {
    let text = PENDULUM.replace("mass = 1.0", "mas = 1.0 # 𝜑 and 🙂");
    let text = text.replace("# heavy", "# 🙂🙂");
    let reply = sent(&json!({ "call": "diagnose", "scene": { "name": "p.toml", "text": text } }));
    let problem = reply["done"]
        .as_array()
        .expect("problems")
        .iter()
        .find(|p| {
            p["message"]
                .as_str()
                .is_some_and(|m| m.contains("has no key `mas`"))
        });
    let mark = &problem.expect("the key")["marks"][0];
    let units: Vec<u16> = text.encode_utf16().collect();
    let [from, to] = ["from", "to"].map(|end| mark[end].as_u64().expect("a number") as usize);
    assert_eq!(String::from_utf16_lossy(&units[from..to]), "mas");
}

#[test]
fn keys_values_and_names_are_completed() {
    let reply = complete(PENDULUM, "[[joi");
    assert!(labels(&reply).contains(&"joint"), "{reply}");
    // Keys that the table has are not listed again; needed keys come first.
    let text = PENDULUM.replace("mass = 1.0\n", "\n");
    let reply = complete(&text, "# heavy\n");
    assert_eq!(labels(&reply)[0], "mass", "{reply}");
    assert!(!labels(&reply).contains(&"inertia"), "{reply}");
    let reply = complete(PENDULUM, "type = \"revo");
    assert!(labels(&reply).contains(&"revolute") && labels(&reply).contains(&"translational"));
    assert!(
        !labels(&reply).contains(&"spherical"),
        "a type of the plane: {reply}"
    );
    assert_eq!(reply["done"]["is_quoted"], true);
    let reply = complete(PENDULUM, "bodies = [\"gro");
    assert_eq!(labels(&reply), ["ground", "bob"]);
    let text = PENDULUM.replace("\"plane\"", "\"spatial\"");
    assert!(labels(&complete(&text, "type = \"revo")).contains(&"spherical"));
}

#[test]
fn an_unfinished_scene_is_completed_too() {
    for end in [
        "[[joint]]\ntype = \"",
        "[[joint]]\ntype = ",
        "joint = [{ type = \"",
    ] {
        let reply = complete(end, end);
        assert!(labels(&reply).contains(&"revolute"), "{end}: {reply}");
    }
    for end in [
        "[sim",
        "[",
        "si",
        "\"",
        "[[\n",
        "a = [{ b = {",
        "'''",
        "x = \"\\",
        "é = \"µ",
        "[[",
    ] {
        for k in 0..=end.len() {
            let request = json!({ "call": "complete", "text": end, "offset": k });
            assert!(sent(&request)["done"]["options"].is_array(), "{end} {k}");
            let request = json!({ "call": "hover", "text": end, "offset": k });
            assert!(sent(&request).get("done").is_some(), "{end} {k}");
        }
    }
}

#[test]
fn hostile_texts_are_completed_in_linear_time() {
    for part in [
        "{b=",
        "[",
        "(",
        "\"",
        "a = {",
        "[[a]]\n",
        "a.",
        "'''\n",
        "\u{1f642}",
    ] {
        let text = format!("a = {}", part.repeat(50_000));
        for offset in [0, text.len() / 2, text.len()] {
            let request = json!({ "call": "complete", "text": text, "offset": offset });
            assert!(sent(&request)["done"]["options"].is_array(), "{part}");
        }
    }
}

#[test]
fn every_offset_of_a_scene_has_a_description_or_none() {
    for text in [PENDULUM, include_str!("../../../examples/hooke.toml")] {
        for offset in 0..text.len() + 3 {
            let reply = sent(&json!({ "call": "hover", "text": text, "offset": offset }));
            assert!(reply.get("done").is_some(), "{offset}");
        }
    }
    let hover = |part: &str| {
        sent(&json!({ "call": "hover", "text": PENDULUM, "offset": after(PENDULUM, part) }))
    };
    let text = |reply: &Value| {
        reply["done"]["text"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    assert!(
        text(&hover("[[bod")).contains("Rigid bodies"),
        "{}",
        hover("[[bod")
    );
    assert!(text(&hover("inert")).to_lowercase().contains("inertia"));
    assert_eq!(hover("type = \"rev")["done"]["title"], "revolute");
}

#[test]
fn a_dragged_body_goes_where_its_joints_allow() {
    let placed = |pose: Value| {
        let scene = json!({ "name": "p.toml", "text": PENDULUM });
        sent(&json!({ "call": "place", "scene": scene, "body": "bob", "pose": pose }))
    };
    // The nearest point of the unit circle about the pivot.
    let reply = placed(json!({ "position": [0.0, -3.0], "angle": -FRAC_PI_2 }));
    let text = reply["done"].as_str().expect("a text");
    assert!(
        text.contains("name = \"bob\"   # heavy"),
        "comments stay: {text}"
    );
    let reply = sent(&json!({
        "call": "ask", "question": "analyze", "scenes": [{ "name": "p.toml", "text": text }],
    }));
    assert_eq!(reply["done"]["document"]["rank"], 2, "{text}\n{reply}");
    let start: Vec<f64> = text
        .split("position = [")
        .nth(1)
        .and_then(|rest| {
            rest.split(']')
                .next()?
                .split(", ")
                .map(|x| x.parse().ok())
                .collect()
        })
        .expect("the position");
    assert!(
        (start[0]).abs() < 1e-6 && (start[1] + 1.0).abs() < 1e-6,
        "{start:?}"
    );
    let reply = sent(&json!({
        "call": "place", "scene": { "name": "p.toml", "text": PENDULUM }, "body": "bop", "pose": {},
    }));
    assert!(
        reply["refused"]["error"]
            .as_str()
            .is_some_and(|e| e.contains("did you mean `bob`"))
    );
}

#[test]
fn the_example_scenes_are_listed_with_their_texts() {
    let reply = sent(&json!({ "call": "about" }));
    let examples = reply["done"]["examples"].as_array().expect("examples");
    assert!(examples.len() > 30 && examples.iter().all(|e| e["text"].is_string()));
    let questions = reply["done"]["questions"].as_array().expect("questions");
    assert!(questions.iter().any(|q| q["name"] == "analyze"));
}
