//! The twelve machines of `docs/reports/first-minutes/machines.md` against virtual work and
//! equilibrium. The geometry is computed here, from the numbers of the drawings.

mod jet;
mod plane;
mod space;
mod tables;
mod works;

use std::collections::BTreeSet;
use std::fs;

use pfaff::model::Registry;

/// Every machine has a test, and is described on the page.
#[test]
fn each_machine_is_tested_and_described() {
    let files = fs::read_dir(tables::folder()).expect("a folder").flatten();
    let found: BTreeSet<String> = files
        .filter_map(|file| {
            let name = file.file_name().into_string().ok()?;
            name.strip_suffix(".toml").map(str::to_owned)
        })
        .collect();
    let tested = [plane::MACHINES, space::MACHINES].concat();
    let tested: BTreeSet<String> = tested.into_iter().map(str::to_owned).collect();
    assert_eq!(found, tested);
    let page = tables::folder().with_extension("md");
    let page = fs::read_to_string(page).expect("the page");
    for name in &found {
        assert!(
            page.contains(&format!("[{name}.toml](machines/{name}.toml)")),
            "{name}"
        );
        let text = tables::scene(name, None);
        let scene = pfaff::scene::read("scene.toml", &text, &Registry::standard());
        assert!(scene.is_ok_and(|scene| !scene.cases.is_empty()), "{name}");
    }
}
