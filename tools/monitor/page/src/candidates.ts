import * as THREE from "three";
import { Body } from "./body";
import type { Order } from "./connection";
import { cell, color, element } from "./dom";
import type { MapView } from "./map_view";
import type { CameraInfo, Places } from "./status";

const SURE = 4.5; // standard deviations: chance stays below (lcmtypes/places_t.lcm)
const LISTED = 5;

// Its number, beside a candidate in the map.
function label(text: string, css: string): THREE.Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d")!;
  context.font = "bold 44px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = css;
  context.fillText(text, 32, 34);
  const material = new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), sizeAttenuation: false, depthTest: false });
  const sprite = new THREE.Sprite(material);
  sprite.scale.setScalar(0.035);
  return sprite;
}

// Where the body may be, while the tracker looks for its place: in the map and as a list, from which one can be given.
export class Candidates {
  private readonly list = element("candidates");
  private bodies: Body[] = [];
  private labels: THREE.Sprite[] = [];
  private places: Places["places"] = [];
  private camera: CameraInfo | null = null;
  private readOnly = false;

  constructor(
    private readonly view: MapView,
    private readonly send: (order: Order) => void,
  ) {}

  get any(): boolean {
    return this.places.length > 0;
  }

  setCamera(camera: CameraInfo | null, readOnly: boolean): void {
    this.camera = camera;
    this.readOnly = readOnly;
  }

  show(places: Places["places"]): void {
    if (places.length === 0 && this.places.length === 0) return;
    this.clear();
    this.places = places;
    places.forEach((place, i) => this.draw(place, i));
    this.fillList();
    this.view.onLegend();
    this.view.invalidate();
  }

  private clear(): void {
    for (const body of this.bodies) {
      this.view.scene.remove(body.object);
      body.dispose();
    }
    for (const sprite of this.labels) {
      this.view.scene.remove(sprite);
      sprite.material.map?.dispose();
      sprite.material.dispose();
    }
    this.bodies = [];
    this.labels = [];
  }

  private draw(place: Places["places"][number], i: number): void {
    const body = new Body({ width: i === 0 ? 2.5 : 1.5 });
    body.setCamera(this.camera);
    body.setColor(color("place"));
    body.setOpacity(place.significance >= SURE ? 1 : 0.4);
    body.place(place.position, place.orientation);
    this.bodies.push(body);
    this.view.scene.add(body.object);
    if (i >= LISTED) return;
    const sprite = label(String(i + 1), color("ink"));
    sprite.position.fromArray(place.position);
    this.labels.push(sprite);
    this.view.scene.add(sprite);
  }

  private fillList(): void {
    this.list.hidden = this.places.length === 0;
    if (this.list.hidden) return;
    const head = document.createElement("p");
    head.innerHTML = `<b>Where it may be</b> – ${SURE} σ and more is better than chance`;
    const table = document.createElement("table");
    this.places.slice(0, LISTED).forEach((place, i) => {
      const row = document.createElement("tr");
      const use = document.createElement("td");
      use.className = "number";
      const button = document.createElement("button");
      button.textContent = "Use";
      button.title = "Give the tracker this pose";
      button.disabled = this.readOnly;
      button.onclick = () => this.send({ order: "hint", position: place.position, orientation: place.orientation });
      use.append(button);
      row.append(
        cell(String(i + 1)),
        cell(`${place.position.map((x) => x.toFixed(2).padStart(6)).join(" ")} m`, "number"),
        cell(`${place.significance.toFixed(1)} σ`, "number"),
        use,
      );
      table.append(row);
    });
    this.list.replaceChildren(head, table);
  }
}
