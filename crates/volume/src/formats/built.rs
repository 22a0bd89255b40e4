//! What a build has, and what it leaves out.

/// What a feature brings, or `None` where it is left out.
#[doc(hidden)]
#[macro_export]
macro_rules! __built {
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
pub use __built as built;
