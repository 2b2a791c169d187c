//! A file system of its own, for disks that are full or read-only.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::tools;

/// A file system of its own on a folder, for as long as this lives; none where mounting is refused.
pub struct Mount(PathBuf);

impl Mount {
    /// With the options of a `tmpfs`.
    pub fn new(folder: &Path, options: &str) -> Option<Self> {
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(folder);
        let is_mounted = mount.output().is_ok_and(|output| output.status.success());
        if !is_mounted {
            tools::missing_mount();
        }
        is_mounted.then(|| Self(folder.to_owned()))
    }

    /// Changes the options.
    pub fn remount(&self, options: &str) {
        let options = format!("remount,{options}");
        assert!(Command::new("mount").args(["-o", &options]).arg(&self.0).status().unwrap().success());
    }
}

impl Drop for Mount {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}
