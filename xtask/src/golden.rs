//! `cargo xtask golden`: regenerates what is compared with our own past.

use crate::{pack, shell, workspace};

/// Writes the example's modelDescription.xml; a diff there is a change of the public interface.
pub fn command() -> Result<(), String> {
    let (package, _) = pack::describe(&workspace().join("examples/three_stage.toml"))?;
    let path = workspace().join("modelDescription/modelDescription.xml");
    shell::write(&path, package.model_description.as_bytes())?;
    println!("{}: review its diff before committing", path.display());
    Ok(())
}
