"""Response models of histories and networks, shared by the command line and the service."""
