//! What a build has, and what it leaves out.

/// What a feature brings, or `None` where it is left out.
macro_rules! built {
    ($feature:tt, $what:expr) => {{
        #[cfg(feature = $feature)]
        {
            Some($what)
        }
        #[cfg(not(feature = $feature))]
        {
            None
        }
    }};
}
pub(crate) use built;
