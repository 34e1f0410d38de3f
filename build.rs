//! Link options of the shared library.
#![allow(clippy::print_stdout)] // that is how a build script talks to cargo

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        // A thread that used the library's standard library and ends after dlclose would run code that is
        // gone: keep the library mapped.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
}
