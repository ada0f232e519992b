//! Scenes in space for tests of generated code.

use std::path::Path;

/// Returns names and texts of the spatial scenes in `examples` and in the folder of this file.
pub(crate) fn scenes() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scenes = Vec::new();
    for folder in ["../../examples", "tests/space"] {
        let files = std::fs::read_dir(root.join(folder)).expect("a folder of scenes");
        let mut paths: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
        paths.sort();
        for path in paths {
            let is_scene = path.extension().is_some_and(|end| end == "toml");
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if is_scene && text.contains("space = \"spatial\"") {
                let name = path.file_stem().expect("a name").to_string_lossy();
                scenes.push((name.into_owned(), text));
            }
        }
    }
    assert!(scenes.len() >= 14, "{} scenes", scenes.len());
    scenes
}
