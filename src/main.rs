fn main() -> std::process::ExitCode {
    gonio::cli::main()
}
