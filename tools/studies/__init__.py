"""Studies of error against time, for tools/study: the command line is in __main__.py."""
