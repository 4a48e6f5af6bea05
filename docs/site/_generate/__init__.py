"""Pages that are made when the site is built: the command line, the keys of files, documents of the project."""
