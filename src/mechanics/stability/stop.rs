//! A request to stop, which a long search for modes looks at.

use super::error::StabilityError;
use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

/// Says whether somebody has asked to stop. By default nobody does.
#[derive(Clone, Default)]
pub struct Stop(Option<Arc<dyn Fn() -> bool + Send + Sync>>);

impl Stop {
    /// A request that `is_asked` tells. Threads ask it now and then.
    pub fn when(is_asked: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(is_asked)))
    }

    /// Checks that nobody has asked to stop.
    ///
    /// # Errors
    /// [`StabilityError::Interrupted`] if somebody has.
    pub(super) fn check(&self) -> Result<(), StabilityError> {
        if self.0.as_ref().is_some_and(|is_asked| is_asked()) {
            Err(StabilityError::Interrupted)
        } else {
            Ok(())
        }
    }
}

impl Debug for Stop {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.debug_tuple("Stop").field(&self.0.is_some()).finish()
    }
}
