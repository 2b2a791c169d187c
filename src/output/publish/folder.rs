//! Files that are replaced as a whole, alone and in a folder.

use super::error::PublishError;
use super::table::{Column, Format, Head, Table, TableWriter};
use std::borrow::Borrow;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// A folder that files are written into, each as a whole. Links in it are replaced and not followed; the folder itself may be a link.
///
/// The folder has a hidden file that lists what was written. The next time, files of that list that were not written
/// again are removed, so that the folder has exactly the files of one result. Other files are never touched.
pub struct Folder<'a> {
    path: &'a Path,
    kind: &'static str,
    /// The files written so far, relative to the folder.
    written: Vec<String>,
    /// The files that were written the last time; none if there is no list.
    earlier: Option<Vec<String>>,
}

impl<'a> Folder<'a> {
    /// Creates the folder and its parents if they do not exist. Results of another `kind` in the same folder have a list
    /// of their own.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn create(path: &'a Path, kind: &'static str) -> Result<Self, PublishError> {
        fs::create_dir_all(path).map_err(|source| PublishError::Folder { path: path.to_owned(), source })?;
        let list = path.join(list_name(kind));
        let earlier = if list.is_symlink() { None } else { fs::read_to_string(list).ok() };
        let earlier =
            earlier.map(|text| text.lines().filter(|line| is_inside(line)).map(str::to_owned).collect());
        Ok(Self { path, kind, written: Vec::new(), earlier })
    }

    /// The names of the files written so far.
    pub fn written(&self) -> &[String] {
        &self.written
    }

    /// The path of the file with this name, which need not exist. A name may have folders in it, separated by `/`.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file of text.
    ///
    /// # Errors
    /// If it cannot be written. An earlier version of it is then unchanged.
    pub fn write_text(&mut self, name: &str, text: &str) -> Result<(), PublishError> {
        self.replace_with(name, |out| out.write_all(text.as_bytes()))
    }

    /// Writes a table as CSV, and returns the name of the file.
    ///
    /// # Errors
    /// As [`Folder::write_text`].
    pub fn write_table(&mut self, table: &Table) -> Result<String, PublishError> {
        let name = format!("{}.csv", table.stem);
        self.write_with(&name, |out| table.write(Format::Csv, out))?;
        Ok(name)
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
        self.replace_with(name, |out| {
            let mut contents = Vec::new();
            fill(&mut contents)?;
            out.write_all(&contents)
        })
    }

    fn replace_with(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), PublishError> {
        let path = self.path_of(name);
        match replace(&path, write) {
            Ok(()) => {
                self.written.push(name.to_owned());
                Ok(())
            }
            Err(source) => Err(PublishError::File { path, source }),
        }
    }

    /// Writes a table as CSV, line by line, so that a large one is never in memory as text.
    ///
    /// # Errors
    /// As [`Folder::write_text`].
    pub fn write_lines<T>(
        &mut self,
        name: &str,
        columns: &[Column<T>],
        subjects: impl IntoIterator<Item = impl Borrow<T>>,
    ) -> Result<(), PublishError> {
        let heads: Vec<Head> = columns.iter().map(|column| column.head.clone()).collect();
        self.replace_with(name, |out| {
            let mut writer = TableWriter::new(Format::Csv, &heads, out)?;
            for of in subjects {
                writer.line(columns.iter().map(|column| column.value(of.borrow())))?;
            }
            writer.finish().map(drop)
        })
    }

    /// Creates a folder inside this one. Its files have names with the folder's name before them.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn create_inside(&self, name: &str) -> Result<(), PublishError> {
        let path = self.path_of(name);
        // A link would lead the files of the folder elsewhere.
        if path.is_symlink() {
            fs::remove_file(&path).map_err(|source| PublishError::Removal { path: path.clone(), source })?;
        }
        fs::create_dir_all(&path).map_err(|source| PublishError::Folder { path, source })
    }

    /// Removes the files of the last time that were not written again, and stores the list of those that were; returns
    /// their paths.
    ///
    /// # Errors
    /// If a file cannot be removed, or the list cannot be written.
    pub fn finish(mut self) -> Result<Vec<PathBuf>, PublishError> {
        let earlier = self.earlier.clone().unwrap_or_default();
        for name in earlier.iter().filter(|name| !self.written.contains(name)) {
            let path = self.path_of(name);
            // Somebody may have removed the file, or put a folder in its place.
            if path.symlink_metadata().is_ok_and(|found| !found.is_dir()) {
                fs::remove_file(&path).map_err(|source| PublishError::Removal { path, source })?;
            }
        }
        self.earlier = None;
        self.store(&self.written)?;
        Ok(self.paths())
    }

    /// Stores the list of files, with those of the last time that are still there; returns the paths of the files that
    /// were written.
    ///
    /// # Errors
    /// If the list cannot be written.
    pub fn finish_beside_earlier(mut self) -> Result<Vec<PathBuf>, PublishError> {
        let earlier = self.earlier.take().unwrap_or_default();
        let others =
            earlier.into_iter().filter(|name| !self.written.contains(name) && self.path_of(name).is_file());
        let all: Vec<String> = others.chain(self.written.iter().cloned()).collect();
        self.store(&all)?;
        Ok(self.paths())
    }

    fn paths(&self) -> Vec<PathBuf> {
        self.written.iter().map(|name| self.path.join(name)).collect()
    }

    fn store(&self, names: &[String]) -> Result<(), PublishError> {
        let path = self.path.join(list_name(self.kind));
        let text: String = names.iter().flat_map(|name| [name.as_str(), "\n"]).collect();
        replace(&path, |out| out.write_all(text.as_bytes()))
            .map_err(|source| PublishError::File { path, source })
    }
}

impl Drop for Folder<'_> {
    /// If the result was not finished, the folder has files of both times, and the list names both. This is not possible
    /// where the folder cannot be written, which has been reported already.
    fn drop(&mut self) {
        if let Some(mut names) = self.earlier.take().filter(|_| !self.written.is_empty()) {
            names.extend(
                self.written.iter().filter(|name| !names.contains(name)).cloned().collect::<Vec<_>>(),
            );
            let _ = self.store(&names);
        }
    }
}

/// The name of the hidden file that lists the files of a result.
fn list_name(kind: &str) -> String {
    format!(".tribosweep-{kind}")
}

/// Whether a line of a list is the name of a file inside the folder. A list that somebody edited must not lead outside.
fn is_inside(name: &str) -> bool {
    let path = Path::new(name);
    !name.is_empty() && path.components().all(|part| matches!(part, Component::Normal(_)))
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
    replace(&path.canonicalize().unwrap_or_else(|_| path.to_owned()), write)
}

/// As [`write_atomically`], but whatever is at `path` is replaced, except for a folder: of a symbolic link the link itself. A folder
/// that somebody else prepared leads to no other file.
fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // A bare file name has the empty path as its parent.
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Created like any new file, so that it has the permissions that the umask leaves, and so that errors do not name it.
    let create = |path: &Path| fs::OpenOptions::new().write(true).create_new(true).open(path);
    let mut temporary = tempfile::Builder::new().suffix(".tmp").make_in(parent, create)?;
    fill(temporary.as_file_mut(), write)?;
    temporary.persist(path).map_err(|error| error.error)?;
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

    /// Protects: a folder has the files of the last result alone, also in a folder inside; files of others stay, and a list
    /// that was tampered with does not lead outside.
    #[test]
    fn stale_files_are_removed() {
        let outside = tempfile::tempdir().unwrap();
        let path = outside.path().join("result");
        fs::write(outside.path().join("other"), "").unwrap();
        let write = |names: &[&str]| {
            let mut folder = Folder::create(&path, "test").unwrap();
            folder.create_inside("frames").unwrap();
            for name in names {
                folder.write_text(name, name).unwrap();
            }
            folder.finish().unwrap()
        };
        assert_eq!(write(&["a", "b", "frames/1", "frames/2"]).len(), 4);
        fs::write(path.join("notes"), "mine").unwrap();
        write(&["b", "c", "frames/1"]);
        assert_eq!(names(&path), [".tribosweep-test", "b", "c", "frames", "notes"]);
        assert_eq!(names(&path.join("frames")), ["1"]);

        fs::write(path.join(".tribosweep-test"), "b\n../other\n/etc/passwd\n\n").unwrap();
        write(&["c"]);
        assert_eq!(names(&path), [".tribosweep-test", "c", "frames", "notes"]);
        assert!(outside.path().join("other").is_file());
    }

    /// Protects: a result that is interrupted removes nothing, and the next one removes the files of both.
    #[test]
    fn an_interrupted_result_is_cleared_by_the_next() {
        let path = tempfile::tempdir().unwrap();
        let begin = || Folder::create(path.path(), "test").unwrap();
        let mut folder = begin();
        folder.write_text("a", "").unwrap();
        folder.finish().unwrap();
        let mut folder = begin();
        folder.write_text("b", "").unwrap();
        drop(folder);
        assert_eq!(names(path.path()), [".tribosweep-test", "a", "b"]);
        let mut folder = begin();
        folder.write_text("c", "").unwrap();
        folder.finish().unwrap();
        assert_eq!(names(path.path()), [".tribosweep-test", "c"]);
    }

    /// Protects: in a folder without a list no file is removed: a name alone does not tell whose it is.
    #[test]
    fn a_folder_without_a_list_loses_nothing() {
        let path = tempfile::tempdir().unwrap();
        for name in ["old", "mine"] {
            fs::write(path.path().join(name), "").unwrap();
        }
        let mut folder = Folder::create(path.path(), "test").unwrap();
        folder.write_text("new", "").unwrap();
        folder.finish().unwrap();
        assert_eq!(names(path.path()), [".tribosweep-test", "mine", "new", "old"]);
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

    /// Protects: in a folder of results links are replaced and not followed, be they files, folders or the list, so that no file
    /// outside is written or removed.
    #[cfg(unix)]
    #[test]
    fn links_in_a_folder_are_replaced() {
        use std::os::unix::fs::symlink;
        let outside = tempfile::tempdir().unwrap();
        let (path, precious) = (outside.path().join("result"), outside.path().join("precious"));
        fs::create_dir(&path).unwrap();
        fs::create_dir(outside.path().join("elsewhere")).unwrap();
        fs::write(&precious, "precious\n").unwrap();
        symlink("../precious", path.join("page")).unwrap();
        symlink("../elsewhere", path.join("frames")).unwrap();
        symlink("../precious", path.join(list_name("test"))).unwrap();
        let mut folder = Folder::create(&path, "test").unwrap();
        folder.write_text("page", "new").unwrap();
        folder.create_inside("frames").unwrap();
        folder.write_text("frames/1", "new").unwrap();
        folder.finish().unwrap();
        assert_eq!(fs::read_to_string(&precious).unwrap(), "precious\n");
        assert_eq!(names(&outside.path().join("elsewhere")), [""; 0]);
        assert!(!path.join("page").is_symlink() && fs::read_to_string(path.join("page")).unwrap() == "new");
        assert_eq!(names(&path.join("frames")), ["1"]);
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
