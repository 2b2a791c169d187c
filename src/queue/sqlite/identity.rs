//! Which file lies at a path. A file that is moved, or that another one replaces, keeps its identity, and the path gets
//! another one.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What tells a file from every other one of this machine.
///
/// The time of its creation is there because the system gives the number of a deleted file to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Identity {
    device: u64,
    inode: u64,
    /// In nanoseconds since 1970; 0 where the file system does not store it.
    born_ns: u128,
}

impl Identity {
    /// The identity of the file at `path`, symbolic links followed.
    ///
    /// # Errors
    /// Those of the system; [`ErrorKind::Unsupported`] where files have no such numbers. (There, on Windows, a file that
    /// `SQLite` has open can neither be deleted nor moved.)
    #[cfg(unix)]
    pub fn of(path: &Path) -> io::Result<Self> {
        use std::os::unix::fs::MetadataExt;
        let metadata = fs::metadata(path)?;
        let born = metadata.created().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
        let born_ns = born.map_or(0, |since| since.as_nanos());
        Ok(Self { device: metadata.dev(), inode: metadata.ino(), born_ns })
    }

    /// No file has an identity here.
    #[cfg(not(unix))]
    pub fn of(_: &Path) -> io::Result<Self> {
        Err(ErrorKind::Unsupported.into())
    }

    /// The number of the file on its file system.
    pub fn inode(&self) -> u64 {
        self.inode
    }

    /// Whether another file lies at `path` now, or none. A path that cannot be looked at says nothing.
    pub fn has_left(&self, path: &Path) -> bool {
        match Self::of(path) {
            Ok(now) => now != *self,
            Err(error) => matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory),
        }
    }

    /// Where a file is now that this process has open; none if it was deleted, or if the system does not tell (only Linux
    /// does).
    pub fn present_path(&self) -> Option<PathBuf> {
        for open in fs::read_dir("/proc/self/fd").ok()?.flatten() {
            let open = open.path();
            if Self::of(&open).is_ok_and(|own| own == *self) {
                let path = fs::read_link(open).ok()?;
                // The path of a deleted file ends with a remark. Another file may have that name.
                return Some(path).filter(|path| !self.has_left(path));
            }
        }
        None
    }

    /// One word, which [`Self::from_word`] reads.
    pub fn to_word(self) -> String {
        format!("{}:{}:{}", self.device, self.inode, self.born_ns)
    }

    /// The identity that [`Self::to_word`] wrote.
    pub fn from_word(word: &str) -> Option<Self> {
        let mut numbers = word.split(':');
        let device = numbers.next()?.parse().ok()?;
        let inode = numbers.next()?.parse().ok()?;
        let born_ns = numbers.next()?.parse().ok()?;
        Some(Self { device, inode, born_ns }).filter(|_| numbers.next().is_none())
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Protects: a file that was moved is found at its new path, and its old path has lost it, whether another file is
    /// there or none. A deleted file is nowhere.
    #[test]
    fn a_file_is_followed() {
        let folder = tempfile::TempDir::new().unwrap();
        let (path, other) = (folder.path().join("a b"), folder.path().join("other"));
        fs::write(&path, "1").unwrap();
        let _open = fs::File::open(&path).unwrap();
        let own = Identity::of(&path).unwrap();
        assert!(!own.has_left(&path));
        assert_eq!(Identity::from_word(&own.to_word()), Some(own));
        assert_eq!(Identity::from_word("1:2"), None);
        fs::rename(&path, &other).unwrap();
        assert!(own.has_left(&path) && !own.has_left(&other));
        fs::write(&path, "2").unwrap();
        assert!(own.has_left(&path));
        if cfg!(target_os = "linux") {
            assert_eq!(own.present_path(), Some(other.canonicalize().unwrap()));
        }
        fs::remove_file(&other).unwrap();
        assert_eq!(own.present_path(), None);
    }
}
