"""Configuration of the kernel: no word about the connection to its own machine."""

c = get_config()  # type: ignore[name-defined]  # noqa: F821
c.IPKernelApp.log_level = 40
