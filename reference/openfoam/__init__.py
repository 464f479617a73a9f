"""OpenFOAM as a reference: body-fitted meshes and cases made from a scene, run, and read."""
