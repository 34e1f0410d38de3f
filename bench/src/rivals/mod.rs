//! What a user could pick instead of our solvers.

pub mod cvode;
pub mod diffsol;
pub mod dopri5;
mod elsewhere;
pub mod numpy;
pub mod ours;
pub mod rk4;

/// Runs a loop with the vector instructions of this CPU, as a build for it alone would.
pub fn widest<R>(body: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the CPU has the instructions.
        #[allow(unsafe_code)]
        return unsafe { with_avx2(body) };
    }
    body()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<R>(body: impl FnOnce() -> R) -> R {
    body()
}
