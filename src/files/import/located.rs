//! Find the files that a description names, such as meshes and included files.

use std::path::{Path, PathBuf};

use super::document::Wrong;

/// Folders above that of the description in which its files may be: packages of ROS are beside each other there.
const UP: usize = 4;

/// Where the files of a description are.
#[derive(Clone)]
pub(super) struct Located {
    folder: PathBuf,
    /// All files must be in here.
    top: PathBuf,
}

impl Located {
    /// Those of the description in this file.
    pub(super) fn beside(description: &Path) -> Self {
        let folder = description.parent().unwrap_or(Path::new("")).join(".");
        let folder = folder.canonicalize().unwrap_or(folder);
        let top = folder.ancestors().take(UP + 1).last().unwrap_or(&folder).to_owned();
        Self { folder, top }
    }

    /// Those of a file that the description names: as far up as its own.
    pub(super) fn of(&self, file: &Path) -> Self {
        Self { folder: file.parent().unwrap_or(&self.folder).to_owned(), top: self.top.clone() }
    }

    /// The file of this name in `within`, relative to the description; none if it is not there. Of names such as
    /// `package://NAME/REST`, the package is looked for in the folders above.
    ///
    /// # Errors
    /// If it is outside the folders that a description may name.
    pub(super) fn find(&self, within: &str, name: &str) -> Result<Option<PathBuf>, Wrong> {
        let name = name.replace('\\', "/");
        let found = match name.split_once("://") {
            Some(("package" | "model", rest)) => self.in_package(rest),
            Some(("file", rest)) => Some(PathBuf::from(rest)),
            Some((scheme, _)) => {
                return Err(format!(
                    "is at `{name}`, but {scheme}:// is not read; give the path of a file or package://"
                ));
            }
            None => Some(self.folder.join(within).join(&name)),
        };
        let Some(path) = found.and_then(|path| path.canonicalize().ok()).filter(|path| path.is_file()) else {
            return Ok(None);
        };
        if !path.starts_with(&self.top) {
            return Err(format!(
                "is at `{name}`, more than {UP} folders above; copy it beside the description"
            ));
        }
        Ok(Some(path))
    }

    /// A file by the name of its package and its path in that.
    fn in_package(&self, name: &str) -> Option<PathBuf> {
        let (package, rest) = name.split_once('/')?;
        let above = || self.folder.ancestors().take_while(|folder| folder.starts_with(&self.top));
        let inside = above().filter(|folder| folder.ends_with(package)).map(|folder| folder.join(rest));
        let beside = above().map(|folder| folder.join(name));
        // A package may be unpacked into a folder of another name.
        let renamed = above().map(|folder| folder.join(rest));
        inside.chain(beside).chain(renamed).find(|path| path.is_file())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_are_found_beside_the_description_and_in_packages() {
        let folder = tempfile::tempdir().unwrap();
        let at = |path: &str| folder.path().join(path);
        for path in [
            "a/b/c/d/robot/urdf/r.urdf",
            "a/b/c/d/robot/meshes/m.stl",
            "a/b/c/d/hand/meshes/h.stl",
            "a/far.stl",
        ] {
            fs::create_dir_all(at(path).parent().unwrap()).unwrap();
            fs::write(at(path), "").unwrap();
        }
        let files = Located::beside(&at("a/b/c/d/robot/urdf/r.urdf"));
        let found =
            |name: &str| files.find("", name).unwrap().map(|path| path.file_name().unwrap().to_owned());
        for name in [
            "../meshes/m.stl",
            "package://robot/meshes/m.stl",
            "package://renamed/meshes/m.stl",
            "..\\meshes\\m.stl",
        ] {
            assert_eq!(found(name).unwrap(), "m.stl", "{name}");
        }
        assert_eq!(found("package://hand/meshes/h.stl").unwrap(), "h.stl");
        assert_eq!(files.find("../meshes", "m.stl").unwrap(), files.find("", "../meshes/m.stl").unwrap());
        assert!(found("m.stl").is_none() && found("package://robot").is_none());
        let far = files.find("", "../../../../../far.stl").unwrap_err();
        assert!(
            far.contains("far.stl`, more than 4 folders above") && far.contains("copy it beside"),
            "{far}"
        );
        assert!(files.find("", "https://x/m.stl").unwrap_err().contains("https:// is not read"));
    }
}
