"""All methods behind one protocol: cases in, for each a contact state or a refusal with its reason out."""
