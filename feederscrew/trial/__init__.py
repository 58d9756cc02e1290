"""Parts of true shape on the vibrating, tooled track."""
