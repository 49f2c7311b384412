"""What is told of histories and networks: the same objects on the command line and over HTTP."""
