"""Pages of the site that the code makes: each module turns one kind of fact into Markdown."""
