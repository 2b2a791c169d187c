//! Files that are replaced as a whole, alone and in a folder.

use super::error::PublishError;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A folder that files are written into, each with [`write_atomically`].
pub struct Folder<'a> {
    path: &'a Path,
    /// The files written so far.
    pub written: Vec<PathBuf>,
}

impl<'a> Folder<'a> {
    /// Creates the folder and its parents if they do not exist.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn create(path: &'a Path) -> Result<Self, PublishError> {
        fs::create_dir_all(path).map_err(|source| PublishError::Folder { path: path.to_owned(), source })?;
        Ok(Self { path, written: Vec::new() })
    }

    /// The path of the file with this name, which need not exist.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file of text.
    ///
    /// # Errors
    /// If it cannot be written. An earlier version of it is then unchanged.
    pub fn write_text(&mut self, name: &str, text: &str) -> Result<(), PublishError> {
        self.write_with(name, |contents| {
            contents.extend_from_slice(text.as_bytes());
            Ok(())
        })
    }

    /// Writes a file whose contents `fill` gives.
    ///
    /// # Errors
    /// As [`Folder::write_text`], and those of `fill`.
    pub fn write_with(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut Vec<u8>) -> io::Result<()>,
    ) -> Result<(), PublishError> {
        let path = self.path_of(name);
        let mut contents = Vec::new();
        match fill(&mut contents).and_then(|()| write_atomically(&path, |out| out.write_all(&contents))) {
            Ok(()) => {
                self.written.push(path);
                Ok(())
            }
            Err(source) => Err(PublishError::File { path, source }),
        }
    }
}

/// Writes a file so that readers see the old contents or the new ones, and never a part of them.
///
/// `write` fills a temporary file in the same folder, which then takes the place of `path`. Its name is unique, so
/// several processes may write the same path. The new file has the permissions of any newly created file: those that
/// the umask leaves. If `path` is a symbolic link, the file it points to is replaced. What is no regular file
/// (`/dev/null`, a pipe) is written to directly.
///
/// # Errors
/// Those of `write` and of the file system. An earlier version of the file is then unchanged, and no temporary file is
/// left.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return fill(fs::File::create(path)?, write);
    }
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    // A bare file name has the empty path as its parent.
    let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Created like any new file, so that it has the permissions that the umask leaves, and so that errors do not name it.
    let create = |path: &Path| fs::OpenOptions::new().write(true).create_new(true).open(path);
    let mut temporary = tempfile::Builder::new().suffix(".tmp").make_in(parent, create)?;
    fill(temporary.as_file_mut(), write)?;
    temporary.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

fn fill(file: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names in a folder, sorted.
    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = entries.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Protects: if writing fails half-way, the old file stays as it was and no temporary file is left.
    #[test]
    fn a_failed_write_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        write_atomically(&path, |out| out.write_all(b"old")).unwrap();
        let failed = write_atomically(&path, |out| {
            out.write_all(b"new")?;
            Err(io::Error::other("no more"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "no more");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["file"]);
    }

    /// Protects: an error is that of the system, without the name of a temporary file that no reader knows.
    #[test]
    fn errors_do_not_name_the_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing").join("file");
        let found = write_atomically(&missing, |_| Ok(())).unwrap_err();
        assert_eq!(found.to_string(), fs::File::create(&missing).unwrap_err().to_string());
    }

    /// Protects: the file has the permissions of an ordinary new file, so that others can read a report where the umask
    /// lets them.
    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_a_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        let (ordinary, atomic) = (folder.path().join("ordinary"), folder.path().join("atomic"));
        fs::write(&ordinary, "").unwrap();
        write_atomically(&atomic, |_| Ok(())).unwrap();
        assert_eq!(mode(&atomic), mode(&ordinary));
    }

    /// Protects: a symbolic link stays a link, and the file it points to is replaced.
    #[cfg(unix)]
    #[test]
    fn links_are_followed() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_atomically(&link, |out| out.write_all(b"new")).unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
    }
}
