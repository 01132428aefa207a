#!/usr/bin/python3
"""belvedere-build reads from servers what a spec names there, and nothing else.

    tile_server_test.py BELVEDERE_BUILD

Starts a server on loopback. It shows one picture of the whole Earth, red growing to the east and green to the north, as
a file, as tiles and as maps; each way to name it must give the same colours. The same picture in the files that hold
tiles (MBTiles, GeoPackage) comes along.
"""

import http.server
import math
import pathlib
import subprocess
import sys
import tempfile
import threading
import urllib.parse

import numpy
from osgeo import gdal, osr

gdal.UseExceptions()
HALF_M = 20037508.342789244
PLACES = [(-120.0, 40.0), (10.0, 50.0), (151.0, -33.0), (-60.0, -20.0)]
FAILURES = []


def fail(text):
    print(text)
    FAILURES.append(text)


def colours(longitudes, latitudes):
    """Bands, rows, columns."""
    red = 255 * (longitudes + 180) / 360
    green = 255 * (latitudes + 90) / 180
    return numpy.stack([*numpy.meshgrid(red, green), numpy.full((len(latitudes), len(longitudes)), 90.0)])


def picture(path, bands, transform, epsg, driver="GTiff", options=()):
    memory = gdal.GetDriverByName("MEM").Create("", bands.shape[2], bands.shape[1], 3, gdal.GDT_Byte)
    memory.SetGeoTransform(transform)
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(epsg)
    crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    memory.SetProjection(crs.ExportToWkt())
    memory.WriteArray(numpy.clip(numpy.rint(bands), 0, 255).astype(numpy.uint8))
    gdal.GetDriverByName(driver).CreateCopy(str(path), memory, options=list(options))
    return path


def png(bands):
    name = f"/vsimem/{threading.get_ident()}.png"
    picture(name, bands, (0, 1, 0, 0, 0, -1), 4326, "PNG")
    length = gdal.VSIStatL(name).size
    file = gdal.VSIFOpenL(name, "rb")
    data = bytes(gdal.VSIFReadL(1, length, file))
    gdal.VSIFCloseL(file)
    gdal.Unlink(name)
    return data


def tile(zoom, x, y):
    """Web Mercator, y from the north."""
    pixels = (numpy.arange(256) + 0.5) / 256
    share_x, share_y = (x + pixels) / 2**zoom, (y + pixels) / 2**zoom
    latitudes = numpy.degrees(numpy.arctan(numpy.sinh(math.pi * (1 - 2 * share_y))))
    return png(colours(360 * share_x - 180, latitudes))


def wms(query):
    west, south, east, north = map(float, query["BBOX"][0].split(","))
    width, height = int(query["WIDTH"][0]), int(query["HEIGHT"][0])
    return png(colours(west + (east - west) * (numpy.arange(width) + 0.5) / width,
                       north - (north - south) * (numpy.arange(height) + 0.5) / height))


def wmts_capabilities(base):
    matrices = "".join(
        f"<TileMatrix><ows:Identifier>{z}</ows:Identifier><ScaleDenominator>{559082264.0287178 / 2**z}</ScaleDenominator>"
        f"<TopLeftCorner>-{HALF_M} {HALF_M}</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256</TileHeight>"
        f"<MatrixWidth>{2**z}</MatrixWidth><MatrixHeight>{2**z}</MatrixHeight></TileMatrix>" for z in range(3))
    return f"""<?xml version="1.0"?><Capabilities xmlns="http://www.opengis.net/wmts/1.0"
 xmlns:ows="http://www.opengis.net/ows/1.1" version="1.0.0"><Contents><Layer><ows:Title>earth</ows:Title>
 <ows:Identifier>earth</ows:Identifier><Style isDefault="true"><ows:Identifier>default</ows:Identifier></Style>
 <Format>image/png</Format><TileMatrixSetLink><TileMatrixSet>mercator</TileMatrixSet></TileMatrixSetLink>
 <ResourceURL format="image/png" resourceType="tile" template="{base}/xyz/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png"/>
 </Layer><TileMatrixSet><ows:Identifier>mercator</ows:Identifier>
 <ows:SupportedCRS>urn:ogc:def:crs:EPSG::3857</ows:SupportedCRS>{matrices}</TileMatrixSet></Contents></Capabilities>""".encode()


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, files):
        self.files, self.asked = files, []
        super().__init__(("127.0.0.1", 0), Handler)
        self.base = f"http://127.0.0.1:{self.server_address[1]}"


class Handler(http.server.BaseHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def body(self):
        url = urllib.parse.urlparse(self.path)
        words = url.path.strip("/").split("/")
        if words[0] in ("xyz", "tms") and len(words) == 4:
            zoom, x, y = int(words[1]), int(words[2]), int(words[3].removesuffix(".png"))
            if (zoom, x, y) == (2, 0, 3):
                return None  # the far south-west is not there
            return tile(zoom, x, y if words[0] == "xyz" else 2**zoom - 1 - y)
        if words[0] == "wms":
            return wms({key.upper(): value for key, value in urllib.parse.parse_qs(url.query).items()})
        if words[0] == "wmts.xml":
            return wmts_capabilities(self.server.base)
        path = self.server.files / words[-1]
        return path.read_bytes() if path.is_file() else None

    def do_HEAD(self):
        self.answer(False)

    def do_GET(self):
        self.answer(True)

    def answer(self, with_body):
        self.server.asked.append(self.path)
        data = self.body()
        if data is None:
            self.send_error(404)
            return
        first, last, code = 0, len(data) - 1, 200
        if wanted := self.headers.get("Range"):
            begin, end = wanted.removeprefix("bytes=").split("-")
            first, last, code = int(begin), min(int(end or last), last), 206
        self.send_response(code)
        self.send_header("Accept-Ranges", "bytes")
        self.send_header("Content-Length", str(last - first + 1))
        if code == 206:
            self.send_header("Content-Range", f"bytes {first}-{last}/{len(data)}")
        self.end_headers()
        if with_body:
            self.wfile.write(data[first : last + 1])


class Test:
    def __init__(self, program, folder):
        self.program, self.folder, self.called_from = program, folder, folder / "called_from"
        self.called_from.mkdir()

    def build(self, path, more=""):
        """The result of a build of one source of imagery; its path as a TOML literal."""
        spec = self.folder / "spec.toml"
        spec.write_text(f"[[layer]]\nname = 'imagery'\nkind = 'imagery'\n[[layer.source]]\npath = '''{path}'''\n{more}\n")
        return subprocess.run([self.program, spec, "--out", self.folder / "out", "--jobs", "2", "--no-report"],
                              capture_output=True, text=True, check=False, cwd=self.called_from)

    def expect_colours(self, what, path, more="", tolerance=4, places=tuple(PLACES)):
        built = self.build(path, more)
        if built.returncode != 0:
            fail(f"{what}: exit code {built.returncode}: {built.stderr}")
            return
        exported = self.folder / "exported.tif"
        exported.unlink(missing_ok=True)
        subprocess.run([self.program, "export", self.folder / "out", "--layer", "imagery", "--out", exported],
                       capture_output=True, check=True)
        raster = gdal.Open(str(exported))
        x0, dx, _, y0, _, dy = raster.GetGeoTransform()
        for longitude, latitude in places:
            found = raster.ReadAsArray(int((longitude - x0) / dx), int((latitude - y0) / dy), 1, 1)[:, 0, 0]
            wanted = [*colours(numpy.array([longitude]), numpy.array([latitude]))[:, 0, 0], 255]
            if any(abs(float(a) - b) > tolerance for a, b in zip(found, wanted)):
                fail(f"{what}: at {longitude} {latitude} {found.tolist()}, not {wanted}")

    def expect_part(self, server, what, path, more, tiles):
        """That of the tiles no others are asked for, and that there is nothing beside them."""
        before = len(server.asked)
        self.expect_colours(what, path, more, places=[(20.0, 30.0), (60.0, 50.0)])
        asked = {tuple(url.split("?")[0].split("/")[2:4]) for url in server.asked[before:]}
        if asked != tiles:
            fail(f"{what}: tiles asked for {sorted(asked)}, not {sorted(tiles)}")
        raster = gdal.Open(str(self.folder / "exported.tif"))
        x0, dx, _, y0, _, dy = raster.GetGeoTransform()
        column, row = int((-30.0 - x0) / dx), int((30.0 - y0) / dy)
        if 0 <= column < raster.RasterXSize and 0 <= row < raster.RasterYSize and raster.ReadAsArray(column, row, 1, 1)[3, 0, 0]:
            fail(f"{what}: something lies beside the extent")

    def expect_refused_unasked(self, server, what, path):
        before = len(server.asked)
        built = self.build(path)
        if built.returncode != 1:
            fail(f"{what}: exit code {built.returncode}, not 1: {built.stderr}")
        if asked := server.asked[before:]:
            fail(f"{what}: the server was asked for {asked}, though the spec names none")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = folder / "served"
        files.mkdir()
        whole = colours((numpy.arange(1024) + 0.5) * 360 / 1024 - 180, 90 - (numpy.arange(512) + 0.5) * 180 / 512)
        plate = picture(files / "earth.tif", whole, (-180, 360 / 1024, 0, 90, 0, -180 / 512), 4326, "COG")
        picture(folder / "local.tif", whole, (-180, 360 / 1024, 0, 90, 0, -180 / 512), 4326)
        gdal.Warp(str(folder / "mercator.tif"), str(plate), dstSRS="EPSG:3857", width=1024, height=1024,
                  outputBounds=(-HALF_M, -HALF_M, HALF_M, HALF_M), resampleAlg="bilinear")
        gdal.Translate(str(folder / "earth.mbtiles"), str(folder / "mercator.tif"), format="MBTiles",
                       creationOptions=["TILE_FORMAT=PNG"])
        gdal.Translate(str(folder / "earth.gpkg"), str(folder / "local.tif"), format="GPKG",
                       creationOptions=["TILE_FORMAT=PNG"])
        server = Server(files)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        test = Test(pathlib.Path(sys.argv[1]).resolve(), folder)

        test.expect_colours("a file here", "local.tif")
        test.expect_colours("MBTiles", "earth.mbtiles")
        test.expect_colours("GeoPackage", "GPKG:" + str(folder / "earth.gpkg"))
        test.expect_colours("a file on a server", f"{server.base}/earth.tif")
        test.expect_colours("XYZ tiles", server.base + "/xyz/{z}/{x}/{y}.png", "zoom = 2")
        test.expect_colours("TMS tiles", server.base + "/tms/{z}/{x}/{-y}.png?a=1&b=2", "zoom = 2")
        extent = "zoom = 3\nextent = [1, 1, 89, 66]"  # a quarter of the north, two tiles by two at zoom 3
        columns = {("3", "4"), ("3", "5")}
        test.expect_part(server, "a part of XYZ tiles", server.base + "/xyz/{z}/{x}/{y}.png", extent, columns)
        test.expect_part(server, "a part of TMS tiles", server.base + "/tms/{z}/{x}/{-y}.png", extent, columns)
        test.expect_colours("WMTS", f"WMTS:{server.base}/wmts.xml,layer=earth")
        wms_source = (f'<GDAL_WMS><Service name="WMS"><Version>1.1.1</Version><ServerUrl>{server.base}/wms?</ServerUrl>'
                      "<SRS>EPSG:4326</SRS><ImageFormat>image/png</ImageFormat><Layers>earth</Layers></Service><DataWindow>"
                      "<UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX>"
                      "<LowerRightY>-90</LowerRightY><SizeX>1024</SizeX><SizeY>512</SizeY></DataWindow></GDAL_WMS>")
        test.expect_colours("WMS", wms_source)

        # A server that goes away is a source that cannot be read, and says so.
        gone = test.build("http://127.0.0.1:1/earth.tif")
        if gone.returncode != 1 or "127.0.0.1:1" not in gone.stderr:
            fail(f"a server that is not there: exit code {gone.returncode}: {gone.stderr}")

        # Files that send GDAL to a server, in a spec that names none.
        gdal.Translate(str(folder / "far.vrt"), f"/vsicurl/{server.base}/earth.tif", format="VRT")
        test.expect_refused_unasked(server, "a VRT of a file on a server", "far.vrt")
        (folder / "far.xml").write_text(wms_source)
        test.expect_refused_unasked(server, "a file that describes a WMS", "far.xml")
        server.shutdown()
        if left := list(test.called_from.iterdir()):
            fail(f"left in the folder that the builds were called from: {left}")
    return 1 if FAILURES else 0


if __name__ == "__main__":
    sys.exit(main())
