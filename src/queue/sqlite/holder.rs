//! Who holds the lock that every writer needs. The system tells it on Linux only.

use std::fs;
use std::path::Path;

use super::identity::Identity;
use crate::queue::process;

/// The byte of the shared memory that `SQLite` locks for a writing transaction.
const WRITE_LOCK_BYTE: u64 = 120;

/// Which process holds the write lock of the database at `path`, in words: `process 4242 (tribosweep), which is stopped`.
/// None if nobody does, if it is this process, or if the system does not tell.
pub(super) fn in_words(path: &Path) -> Option<String> {
    let mut memory = path.as_os_str().to_owned();
    memory.push("-shm");
    let inode = Identity::of(Path::new(&memory)).ok()?.inode();
    let pid = holder(&fs::read_to_string("/proc/locks").ok()?, inode)?;
    if pid == std::process::id() {
        return None;
    }
    let name = fs::read_to_string(format!("/proc/{pid}/comm")).ok()?;
    let name: String = name.trim().chars().filter(|c| !c.is_control()).collect();
    let advice = if process::is_stopped(pid) {
        format!(", which is stopped: continue it (`kill -CONT {pid}`) or end it (`kill -KILL {pid}`)")
    } else {
        String::new()
    };
    Some(format!("process {pid} ({name}){advice}"))
}

/// The process with an exclusive lock on that byte of the file, as the table of locks has it:
/// `3: POSIX  ADVISORY  WRITE 4242 08:01:1234 120 120`.
fn holder(locks: &str, inode: u64) -> Option<u32> {
    locks.lines().find_map(|line| {
        let fields: Vec<&str> = line.split_ascii_whitespace().collect();
        // Who waits for a lock has an arrow before the kind.
        let [_, "POSIX", _, "WRITE", pid, file, first, last] = fields[..] else { return None };
        let is_file = file.rsplit(':').next()?.parse() == Ok(inode);
        let last = if last == "EOF" { u64::MAX } else { last.parse().ok()? };
        let is_byte = (first.parse().ok()?..=last).contains(&WRITE_LOCK_BYTE);
        pid.parse().ok().filter(|_| is_file && is_byte)
    })
}

#[cfg(test)]
mod tests {
    use super::holder;

    /// Protects: the holder is the process with an exclusive lock on the byte of writers, and neither a reader, nor one that
    /// waits, nor one that has another file.
    #[test]
    fn the_writer_is_found() {
        let locks = "1: POSIX  ADVISORY  READ 11 08:01:77 120 120\n\
                     2: POSIX  ADVISORY  WRITE 12 08:01:78 120 120\n\
                     3: -> POSIX  ADVISORY  WRITE 13 08:01:77 120 120\n\
                     4: POSIX  ADVISORY  WRITE 14 08:01:77 123 123\n\
                     5: FLOCK  ADVISORY  WRITE 15 08:01:77 0 EOF\n\
                     6: POSIX  ADVISORY  WRITE 16 08:01:77 120 120\n";
        assert_eq!(holder(locks, 77), Some(16));
        assert_eq!(holder(locks, 79), None);
        assert_eq!(holder("1: POSIX  ADVISORY  WRITE 9 00:1:77 0 EOF\n", 77), Some(9));
        assert_eq!(holder("", 77), None);
    }
}
