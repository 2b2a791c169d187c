//! The memory of this machine.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// The memory \[byte\] that processes can have here: that of the machine, or of the control group that limits them. `None`
/// if the system does not say.
pub fn memory_here_bytes() -> Option<u64> {
    let refresh = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(refresh).ok()?;
    let machine = Some(system.total_memory()).filter(|&bytes| bytes > 0)?;
    let group = system.cgroup_limits().map(|limits| limits.total_memory).filter(|&bytes| bytes > 0);
    Some(group.map_or(machine, |group| group.min(machine)))
}
