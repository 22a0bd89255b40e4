# walpha in a container:
#   docker build -t walpha .
#   docker run --rm -v "$PWD:/data" walpha shape ct.nii.gz -o bone.ply
FROM rust:1-bookworm AS build
# libcgal-demo holds the skull, which CGAL ships among its examples.
RUN apt-get update \
    && apt-get install -y --no-install-recommends libcgal-dev libcgal-demo g++ \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY . .
RUN cargo install --locked --path . --features dicom,zarr,las --root /usr/local

FROM debian:bookworm-slim
RUN apt-get update \
    && apt-get install -y --no-install-recommends libgmp10 libmpfr6 libstdc++6 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /usr/local/bin/walpha /usr/local/bin/walpha
# Slim images install no documentation, among which Debian has CGAL's data.
COPY --from=build /usr/share/doc/libcgal-dev/data.tar.gz /usr/share/doc/libcgal-dev/data.tar.gz
WORKDIR /data
ENTRYPOINT ["walpha"]
CMD ["--help"]
