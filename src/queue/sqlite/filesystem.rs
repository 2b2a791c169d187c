//! Detects network file systems. A write-ahead log needs memory that all processes of the database share. Network file
//! systems cannot share memory across machines, and their locks are often not reliable.

use std::fs;
use std::path::{Path, PathBuf};

/// The kernel's names of the types. FUSE file systems are listed one by one because most of them are local.
const NETWORK: [&str; 15] = [
    "nfs",
    "nfs4",
    "lustre",
    "cifs",
    "smb3",
    "smbfs",
    "afs",
    "ceph",
    "beegfs",
    "gpfs",
    "panfs",
    "orangefs",
    "fuse.sshfs",
    "fuse.glusterfs",
    "fuse.ceph",
];

/// The type of the network file system that contains `folder` (absolute, without symbolic links), if it is on one.
///
/// Nothing is detected on systems without `/proc/self/mounts`.
pub(super) fn network_kind(folder: &Path) -> Option<String> {
    let mounts = fs::read_to_string("/proc/self/mounts").ok()?;
    kind_of(&mounts, folder).filter(|kind| NETWORK.contains(kind)).map(str::to_owned)
}

/// The type of the file system that contains `folder`: that of the deepest mount point above it. If several file
/// systems are mounted on the same point, the last one counts.
fn kind_of<'a>(mounts: &'a str, folder: &Path) -> Option<&'a str> {
    mounts
        .lines()
        .filter_map(|line| {
            let mut fields = line.split(' ').skip(1);
            Some((unescape(fields.next()?), fields.next()?))
        })
        .filter(|(point, _)| folder.starts_with(point))
        .max_by_key(|(point, _)| point.components().count())
        .map(|(_, kind)| kind)
}

/// The table separates fields by spaces, and it writes white space inside a name in octal.
fn unescape(field: &str) -> PathBuf {
    field.replace("\\040", " ").replace("\\011", "\t").replace("\\012", "\n").replace("\\134", "\\").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOUNTS: &str = "/dev/sda1 / ext4 rw 0 0\n\
                          server:/home /home nfs4 rw 0 0\n\
                          tmpfs /home/ada/local tmpfs rw 0 0\n\
                          auto /data autofs rw 0 0\n\
                          mds@tcp:/fs /data lustre rw 0 0\n\
                          //nas/x /my\\040disk cifs rw 0 0\n";

    /// Protects: the deepest mount point counts, compared by whole path components, and the last one of a stack.
    #[test]
    fn the_deepest_mount_decides() {
        for (folder, kind) in [
            ("/var/tmp", "ext4"),
            ("/home/ada", "nfs4"),
            ("/homework", "ext4"),
            ("/home/ada/local/sweeps", "tmpfs"),
            ("/data/ada", "lustre"),
            ("/my disk/ada", "cifs"),
        ] {
            assert_eq!(kind_of(MOUNTS, Path::new(folder)), Some(kind), "{folder}");
        }
    }
}
