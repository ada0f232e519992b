//! Text about a comparison.

use report::WorkPrecisionDocument;

use crate::question::Ending;
use crate::words::Block;

pub(super) fn of(document: &WorkPrecisionDocument, ending: &Ending) -> Vec<Block> {
    let mut blocks = Vec::new();
    for scene in &document.scenes {
        blocks.push(Block::sentence(if scene.title == scene.name {
            scene.name.clone()
        } else {
            format!("{}: {}", scene.name, scene.title)
        }));
        let reference = &scene.reference;
        let (limit, agreement) = (reference.motion_limit(), &reference.agreement);
        let known = format!("reference accurate to {limit:.0e}. {agreement}");
        let sentences = scene.summary.iter().cloned();
        let sentences = std::iter::once(known).chain(sentences);
        blocks.extend(sentences.map(|sentence| Block::after("  ", sentence)));
    }
    if let Ending::Partial { error, .. } = ending {
        blocks.push(Block::sentence(format!("{error}; partial")));
    }
    blocks.extend(document.summary.iter().map(Block::sentence));
    blocks
}
